"""The paper's models: Faceformer, and its variants seq2seq + co-edge and seq2seq (section 4).

The tables come from ``faceformer features --for faceformer`` (core/src/identify/faceformer/shards),
so that what is trained on is what the program computes. :mod:`.sequences` makes the sequences that
are learned, :mod:`.model` is the network of all three, :mod:`.train` the training command,
:mod:`.export` writes what the program loads, and :mod:`.convert` turns the authors' released
checkpoint into the same.
"""
