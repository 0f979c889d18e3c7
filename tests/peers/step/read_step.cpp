// Reads STEP files by Open CASCADE. Input: a line "path points", then that number of points;
// output: a line per file: solids, shells, faces, 1 if BRepCheck finds it valid, volume, largest
// distance of a point.
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cstdio>
#include <gp_Pnt.hxx>
#include <iostream>
#include <string>

namespace {

constexpr double kVolume = 1e-9;  // of the volume, at most

int count(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape found;
  TopExp::MapShapes(shape, kind, found);
  return found.Extent();
}

}  // namespace

int main() {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  std::string path;
  int points = 0;
  while (std::cin >> path >> points) {
    STEPControl_Reader reader;
    TopoDS_Shape shape;
    if (reader.ReadFile(path.c_str()) == IFSelect_RetDone && reader.TransferRoots() > 0)
      shape = reader.OneShape();
    double farthest = 0.0;
    GProp_GProps volume;
    if (!shape.IsNull()) BRepGProp::VolumeProperties(shape, volume, kVolume, Standard_True);
    for (int i = 0; i < points; ++i) {
      gp_Pnt p;
      double x = 0.0, y = 0.0, z = 0.0;
      std::cin >> x >> y >> z;
      BRepBuilderAPI_MakeVertex vertex(gp_Pnt(x, y, z));
      if (shape.IsNull()) continue;
      TopTools_IndexedMapOfShape shells;
      TopExp::MapShapes(shape, TopAbs_SHELL, shells);  // of a solid a point inside would be at 0
      const BRepExtrema_DistShapeShape between(vertex.Vertex(), shells(1));
      farthest = std::max(farthest, between.Value());
    }
    const bool valid = !shape.IsNull() && BRepCheck_Analyzer(shape).IsValid();
    std::printf("%d %d %d %d %.17g %.3g\n", shape.IsNull() ? 0 : count(shape, TopAbs_SOLID),
                shape.IsNull() ? 0 : count(shape, TopAbs_SHELL),
                shape.IsNull() ? 0 : count(shape, TopAbs_FACE), valid ? 1 : 0, volume.Mass(),
                farthest);
    std::fflush(stdout);
  }
}
