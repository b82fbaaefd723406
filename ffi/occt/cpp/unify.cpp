#include "unify.h"

#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Solid.hxx>

#include "check.h"

namespace faceformer::occt {
namespace {

// Edges of the solid stay, and so do the vertices at which no silhouette ends.
TopTools_MapOfShape shapes_to_keep(const Model &model, const Topology &topology) {
  std::vector<bool> on_silhouette(topology.vertices.size(), false);
  TopTools_MapOfShape keep;
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    const Edge &edge = model.edges[e];
    if (edge.silhouette) {
      on_silhouette[edge.first] = true;
      on_silhouette[edge.last] = true;
    } else {
      keep.Add(topology.edges[e]);
    }
  }
  for (std::size_t v = 0; v < on_silhouette.size(); ++v) {
    if (!on_silhouette[v]) {
      keep.Add(topology.vertices[v]);
    }
  }
  return keep;
}

} // namespace

TopoDS_Shape unify(const Model &model, const Topology &topology, const TopoDS_Shape &solid) {
  ShapeUpgrade_UnifySameDomain unifier(solid, Standard_True, Standard_True, Standard_False);
  unifier.KeepShapes(shapes_to_keep(model, topology));
  unifier.Build();
  const TopoDS_Shape result = unifier.Shape();
  if (result.IsNull() || result.ShapeType() != TopAbs_SOLID) {
    return {};
  }
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(result, TopAbs_FACE, faces);
  if (faces.Extent() != static_cast<int>(model.merged_faces) || !is_sound(model, result)) {
    return {};
  }
  return result;
}

} // namespace faceformer::occt
