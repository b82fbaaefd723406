<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1">
  <context>
    <name>App::Property</name>
    <message>
      <source>Faces that are switched off, each by the names of its edges</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Length in the model of one millimetre in the drawing</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Takes the other of the two solids that look the same</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>The method that finds the faces</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>The sketch, or the edges, that the solid is made from</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Turns the solid upright, or leaves it as drawn on the sketch</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Version of these properties</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>What was found in the drawing and in the solid</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Which set of faces is built: 0 is the best, 1 the next</source>
      <translation type="unfinished"></translation>
    </message>
  </context>
  <context>
    <name>Faceformer</name>
    <message>
      <source>A direction is three numbers, for instance (1, -1, 1).</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>A drawing cannot be taken from {}.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>All selected edges lie on one straight line. A drawing needs lines in two directions.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Alternative {}</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>As Drawn</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Best</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Building the solid</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Building the solid...</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Cancel</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Cone</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Conf.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Confidence: how probable it is that the face is right</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Convert to Solid</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Current View</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Custom</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Cylinder</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Dimetric View</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Direction</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Edges</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Edges: {}</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Edit Solid</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Engine</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Face</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Faceformer</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Flip Depth</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>From a 2D line drawing to a solid</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>General View</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>General View from the Left</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Identify Faces</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Identifying faces</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Isometric View</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Messages</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Nothing is selected. Select a sketch, or edges in a plane.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Orientation</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Other</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Plane</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Planning the solid</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Reading</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Reading the drawing</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Recovering depth</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Scale</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Seen From</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Select a solid: the selection has no faces to draw.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Solid from {}</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Sphere</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Takes the selected lines, or reads the drawing again</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>The direction has no length. Give one such as (1, -1, 1).</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>The scale must be a number above zero.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>The shape has no edges to draw.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>The solid could not be read into FreeCAD.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>There are no edges in the selection. Draw some lines first.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>There is no engine {!r}. The engines are {}.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>There is no orientation {!r}. Choose one of {}.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Torus</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Type</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Upright</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Wireframe from Solid</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Wireframe of {}</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>{} corners are drawn on top of another one. A direction further away from the part's own diagonals and axes gives a clearer drawing.
</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>{} has a coordinate that is not a finite number. Draw it again.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>{} has faces already. Select a sketch or single edges; a solid is turned into a drawing by Wireframe from Solid.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>{} has no lines. Draw some, or select another.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>{} is not an edge. Select edges of a drawing, or a whole sketch.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>{} is not there any more. Select the lines again.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>{} is {:.3g} mm off the plane of the other lines. A drawing must lie in one plane.</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>{}: {} edges</source>
      <translation type="unfinished"></translation>
    </message>
  </context>
  <context>
    <name>FaceformerPreferences</name>
    <message>
      <source> %</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Engine of new solids</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Faces</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>General</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Hide the sketch of a new solid</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Solids</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>The method that finds the faces of a drawing</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Transparency of patches</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Turn the view to a new solid</source>
      <translation type="unfinished"></translation>
    </message>
  </context>
  <context>
    <name>Faceformer_ConvertToSolid</name>
    <message>
      <source>Convert to Solid</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Creates a solid that follows the selected sketch or edges</source>
      <translation type="unfinished"></translation>
    </message>
  </context>
  <context>
    <name>Faceformer_FlipDepth</name>
    <message>
      <source>Flip Depth</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Swaps near and far: the other solid that has the same drawing</source>
      <translation type="unfinished"></translation>
    </message>
  </context>
  <context>
    <name>Faceformer_IdentifyFaces</name>
    <message>
      <source>Finds the faces of the solid that the selected sketch or edges show</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Identify Faces</source>
      <translation type="unfinished"></translation>
    </message>
  </context>
  <context>
    <name>Faceformer_WireframeFromSolid</name>
    <message>
      <source>Creates a sketch with all edges of the selected solid, seen from a direction</source>
      <translation type="unfinished"></translation>
    </message>
    <message>
      <source>Wireframe from Solid...</source>
      <translation type="unfinished"></translation>
    </message>
  </context>
</TS>
