#include "studies/presses/pictures/vtk_text.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <bit>
#include <ostream>

#include "meshes/base/files.h"

namespace fingertip::studies::inline presses::inline pictures::vtk {

namespace {

std::string base64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int length =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                      reinterpret_cast<const unsigned char*>(bytes.data()), int(bytes.size()));
  text.resize(std::size_t(length));
  return text;
}

template <class Number>
void append(std::string& bytes, Number number) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof(Number));
  bytes.append(raw, sizeof(Number));
}

}  // namespace

std::string file_head(const char* type) {
  const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\">\n",
      type, order);
}

std::string data_array(const char* type, const char* name, int components,
                       const std::string& numbers) {
  std::string bytes;
  append(bytes, std::uint64_t(numbers.size()));
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}"
      "</DataArray>\n",
      type, name, components, base64(bytes + numbers));
}

std::string vectors(const char* name, const std::vector<meshes::Vector3>& values) {
  std::string numbers;
  for (const meshes::Vector3& value : values)
    for (int axis = 0; axis < 3; ++axis) append(numbers, float(value[axis]));
  return data_array("Float32", name, 3, numbers);
}

std::string field(const char* name, const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += ' ' + meshes::to_text(value);
  return fmt::format(
      "<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{} </DataArray>\n",
      name, values.size(), text);
}

std::string frame_name(std::size_t frame) {
  return fmt::format("frame_{:04d}.vtu", frame);
}

void write_series(const std::filesystem::path& file, const std::vector<double>& times) {
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << file_head("Collection") << "<Collection>\n";
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
      out << fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n",
                         meshes::to_text(times[frame]), frame_name(frame));
    }
    out << "</Collection>\n</VTKFile>\n";
  });
}

}  // namespace fingertip::studies::inline presses::inline pictures::vtk
