#include "meshes/volume_mesh/step_faces.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <Bnd_Box.hxx>
#include <Interface_InterfaceModel.hxx>
#include <STEPControl_Reader.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_TShape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <limits>
#include <map>
#include <vector>

namespace fingertip::meshes::inline volume_mesh {

struct StepFaces::Face {
  TopoDS_Face shape;
  Bnd_Box box;
  std::string name;
};

struct StepFaces::Faces {
  std::vector<Face> all;
};

namespace {

std::string name_of(const StepShape_FaceSurface& face) {
  if (face.Name().IsNull()) return "";
  const std::string whole = face.Name()->ToCString();
  const std::size_t first = whole.find_first_not_of(' '), last = whole.find_last_not_of(' ');
  const std::string name = first == std::string::npos ? "" : whole.substr(first, last - first + 1);
  return name == "NONE" ? "" : name;
}

/// By what is shared wherever an assembly puts the face.
std::map<const TopoDS_TShape*, std::string> names_in(const STEPControl_Reader& reader) {
  std::map<const TopoDS_TShape*, std::string> names;
  const auto model = reader.WS()->Model();
  const auto process = reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto entity = opencascade::handle<StepShape_FaceSurface>::DownCast(model->Value(i));
    if (entity.IsNull()) continue;
    const std::string name = name_of(*entity);
    const TopoDS_Shape made = TransferBRep::ShapeResult(process, entity);
    if (name.empty() || made.IsNull()) continue;
    for (TopExp_Explorer face(made, TopAbs_FACE); face.More(); face.Next())
      names[face.Current().TShape().get()] = name;
  }
  return names;
}

}  // namespace

StepFaces::StepFaces(const std::filesystem::path& step) : faces_(std::make_unique<Faces>()) {
  STEPControl_Reader reader;
  if (reader.ReadFile(step.c_str()) != IFSelect_RetDone || reader.TransferRoots() == 0) return;
  const auto names = names_in(reader);
  for (TopExp_Explorer face(reader.OneShape(), TopAbs_FACE); face.More(); face.Next()) {
    const auto name = names.find(face.Current().TShape().get());
    Face& added = faces_->all.emplace_back();
    added.shape = TopoDS::Face(face.Current());
    added.name = name == names.end() ? "" : name->second;
    BRepBndLib::Add(added.shape, added.box);
  }
}

StepFaces::~StepFaces() = default;

bool StepFaces::any_named() const {
  return std::ranges::any_of(faces_->all, [](const Face& face) { return !face.name.empty(); });
}

std::string StepFaces::name_at(const Vector3& place) const {
  const gp_Pnt point(place.x(), place.y(), place.z());
  const TopoDS_Vertex vertex = BRepBuilderAPI_MakeVertex(point);
  Bnd_Box here;
  here.Set(point);
  double least = std::numeric_limits<double>::infinity();
  std::string name;
  for (const Face& face : faces_->all) {
    if (face.box.Distance(here) > least) continue;
    const BRepExtrema_DistShapeShape distance(vertex, face.shape);
    if (!distance.IsDone() || distance.Value() >= least) continue;
    least = distance.Value();
    name = face.name;
  }
  return name;
}

}  // namespace fingertip::meshes::inline volume_mesh
