"""What the trained networks share: runs of training, exported weights, random weights for tests."""
