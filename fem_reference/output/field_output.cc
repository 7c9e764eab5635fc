/// Fields as files for ParaView: those of a meridian in space.
#include <Eigen/Geometry>
#include <numbers>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "fem_reference/elements/kinematics.h"
#include "fem_reference/output/press_fields.h"
#include "fem_reference/output/vtu_output.h"
#include "meshes/base/files.h"

namespace fingertip::fem_reference::inline output {
namespace {

Eigen::Matrix3d turn(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// One field of an output: where its rows start in the meridian's data, and how many.
struct OutputField {
  std::string name;
  unsigned first = 0, rows = 1;
};

/// In space a vector has 3 rows, a tensor 9.
unsigned rows_in_space(unsigned rows) {
  return rows == 1 ? 1 : rows == 2 ? 3 : 9;
}

/// A point of the meridian, with its data, in space at an angle around the axis. The last two rows
/// of the meridian's data are its place.
template <class From, class To>
void turn_point(const std::vector<OutputField>& fields, double angle, const From& from,
                unsigned source, To& to, unsigned target) {
  const Eigen::Matrix3d rotation = turn(angle);
  unsigned row = 0;
  const auto put_vector = [&](unsigned first) {
    const Eigen::Vector3d v =
        rotation * Eigen::Vector3d(from(first, source), 0.0, from(first + 1, source));
    for (Eigen::Index i = 0; i < 3; ++i) to(row++, target) = float(v[i]);
  };
  for (const OutputField& field : fields) {
    if (field.rows == 1) {
      to(row++, target) = from(field.first, source);
    } else if (field.rows == 2) {
      put_vector(field.first);
    } else {
      Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
      for (unsigned e = 0; e < field.rows; ++e) {
        const Eigen::Index place = Kinematics<2>::entries[e];
        tensor(place / 3, place % 3) = from(field.first + e, source);
      }
      tensor = rotation * tensor * rotation.transpose();
      for (Eigen::Index i = 0; i < 9; ++i) to(row++, target) = float(tensor(i / 3, i % 3));
    }
  }
  put_vector(from.n_rows() - 2);
}

/// The patches of a meridian as patches in space: surfaces, or the solid of `around` sectors.
template <int solid>
std::vector<dealii::DataOutBase::Patch<solid, 3>> turned(
    const std::vector<dealii::DataOutBase::Patch<2, 2>>& meridian,
    const std::vector<OutputField>& fields, unsigned rows, int around) {
  std::vector<dealii::DataOutBase::Patch<solid, 3>> result;
  // Against the sense of the angle, or the elements would be inside out.
  const double sector = solid == 3 ? -2.0 * std::numbers::pi / around : 0.0;
  for (const auto& patch : meridian) {
    const unsigned points = patch.n_subdivisions + 1, layers = solid == 3 ? points : 1;
    for (int k = 0; k < (solid == 3 ? around : 1); ++k) {
      auto& next = result.emplace_back();
      next.n_subdivisions = patch.n_subdivisions;
      next.patch_index = unsigned(result.size() - 1);
      next.points_are_available = true;
      next.reference_cell = dealii::ReferenceCells::get_hypercube<solid>();
      next.data.reinit(rows + 3, points * points * layers);
      for (unsigned layer = 0; layer < layers; ++layer)
        for (unsigned p = 0; p < points * points; ++p)
          turn_point(fields, sector * (k + double(layer) / patch.n_subdivisions), patch.data, p,
                     next.data, layer * points * points + p);
    }
  }
  return result;
}

}  // namespace

template <>
void FieldOutput<3>::write(const std::filesystem::path& file, int) {
  fem_reference::write_vtu(*this, file);
}

template <>
void FieldOutput<2>::write(const std::filesystem::path& file, int around) {
  using Range = std::tuple<unsigned, unsigned, std::string,
                           dealii::DataComponentInterpretation::DataComponentInterpretation>;
  const std::vector<std::string> names = get_dataset_names();
  std::vector<OutputField> fields;
  for (unsigned row = 0; row < names.size(); ++row) fields.push_back({names[row], row, 1});
  for (const auto& [first, last, name, kind] : get_nonscalar_data_ranges()) {
    fields[first] = {name, first, last - first + 1};
    if (fields[first].rows == 4) fields[first].rows = 5;  // the hoop's stress comes next
    for (unsigned row = 1; row < fields[first].rows; ++row) fields[first + row].rows = 0;
  }
  std::erase_if(fields,
                [](const OutputField& field) { return field.rows == 0 || field.name == no_field; });
  std::vector<std::string> names_in_space;
  std::vector<Range> ranges;
  for (const OutputField& field : fields) {
    using namespace dealii::DataComponentInterpretation;
    const unsigned first = unsigned(names_in_space.size()), rows = rows_in_space(field.rows);
    names_in_space.insert(names_in_space.end(), rows, field.name);
    if (rows > 1)
      ranges.emplace_back(first, first + rows - 1, field.name,
                          rows == 3 ? component_is_part_of_vector : component_is_part_of_tensor);
  }
  const unsigned rows = unsigned(names_in_space.size());
  const dealii::DataOutBase::VtkFlags flags = fast_vtu();
  meshes::write_atomically(file, [&](std::ostream& out) {
    if (around > 0)
      dealii::DataOutBase::write_vtu(turned<3>(get_patches(), fields, rows, around), names_in_space,
                                     ranges, flags, out);
    else
      dealii::DataOutBase::write_vtu(turned<2>(get_patches(), fields, rows, 0), names_in_space,
                                     ranges, flags, out);
  });
}

}  // namespace fingertip::fem_reference::inline output
