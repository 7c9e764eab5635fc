#include "studies/python/tables.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <vector>

#include "lattice/press/trace.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/table_rows.h"

namespace fingertip::studies::inline python {

namespace py = pybind11;

namespace {

/// Rows that never change once they are here, so that columns may look into them.
template <typename Row>
struct Rows {
  std::vector<Row> rows;
};

/// A column that looks into the rows of `self` with their stride, and keeps them alive.
template <typename Value, typename Row>
py::array looking_into(const py::object& self, const std::vector<Row>& rows, const Value* first) {
  py::array_t<Value> column({py::ssize_t(rows.size())}, {py::ssize_t(sizeof(Row))}, first, self);
  column.attr("setflags")(py::arg("write") = false);
  return column;
}

/// The column of that name, "time [s]". Throws KeyError.
template <typename Row>
py::object column_of(const py::object& self, const std::string& name) {
  const std::vector<Row>& rows = self.cast<const Rows<Row>&>().rows;
  py::object found;
  meshes::for_each_column<Row>([&](const auto& field, std::size_t part, const auto& value_of) {
    using Value = std::remove_cvref_t<decltype(value_of(rows.front()))>;
    if (meshes::column_name(field, part) != name) return;
    static const Row none{};
    const Value* first = rows.empty() ? &value_of(none) : &value_of(rows.front());
    found = looking_into<Value>(self, rows, first);
  });
  if (!found) throw py::key_error(name);
  return found;
}

template <typename Row>
void add_table(py::module_& module, const char* name, const char* help,
               std::vector<Row> (*read)(const std::filesystem::path&)) {
  py::class_<Rows<Row>>(module, name, help)
      .def(py::init([read](const std::filesystem::path& file) { return Rows<Row>{read(file)}; }),
           py::arg("file"), py::call_guard<py::gil_scoped_release>())
      .def("__len__", [](const Rows<Row>& table) { return table.rows.size(); })
      .def_property_readonly_static(
          "columns", [](const py::object&) { return meshes::column_names<Row>(); },
          "Names with units, as in the file.")
      .def("column", column_of<Row>, py::arg("name"),
           "A view of one column: no copy, not to be written.");
}

std::vector<meshes::PressSample> read_response(const std::filesystem::path& file) {
  return meshes::PressResponse::read_csv(file).samples();
}

std::vector<lattice::TraceRow> read_trace(const std::filesystem::path& file) {
  return meshes::read_rows<lattice::TraceRow>(file);
}

}  // namespace

void add_tables(py::module_& module) {
  add_table<meshes::PressSample>(module, "ResponseTable", "The rows of response.csv.",
                                 read_response);
  add_table<lattice::TraceRow>(module, "TraceTable", "The rows of trace.csv.", read_trace);
}

}  // namespace fingertip::studies::inline python
