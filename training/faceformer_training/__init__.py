"""Training for Faceformer: from CAD solids to wireframe drawings with their true faces."""
