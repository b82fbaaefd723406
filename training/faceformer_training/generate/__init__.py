"""Random but plausible mechanical solids, made with OpenCASCADE.

``python -m faceformer_training.generate N OUT.tar --seed S`` writes an archive of solids. The way a
solid takes: a *recipe* (:mod:`.recipes`) builds a body from *outlines* (:mod:`.outline`,
:mod:`.sections`), puts *features* (:mod:`.features`) on free *spots* (:mod:`.spots`) of its planar
faces and *dresses* its edges (:mod:`.dress`); :mod:`.finish` normalises and checks the result;
:mod:`.solid` draws anew what was refused; :mod:`.workers` and :mod:`.archive` do so for many.

Solid ``k`` of a seed depends on the seed and on ``k`` only.
"""
