// Python objects -> scenes, with the messages of `weft check`.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "weft/read_scene.h"

namespace weft::python {

namespace py = pybind11;

// JSON text of a Python object; arrays of NumPy become lists. Throws ValueError or TypeError where it
// cannot be JSON.
std::string json_text(const py::handle& value);
py::object json_value(const std::string& text);

// A scene from a dict, or from a path or a shipped scene's name (str, os.PathLike); `values` maps JSON
// pointers to values that replace the scene's. Throws SceneError, whose places name the file.
SceneFile read(const py::object& scene, const py::dict& values);

// Its faults as a SceneError of Python, with `faults` as a list of (place, what, allowed).
void register_errors(py::module_& module);
// Functions read_scene, check_scene, shipped_scenes, scene_schema, estimate.
void register_scenes(py::module_& module);

// A line for each fault: "PLACE: what (allowed)".
std::string lines(const std::vector<Fault>& faults);

}  // namespace weft::python
