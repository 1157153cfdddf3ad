#include "scenes.h"

#include <pybind11/stl.h>

#include <filesystem>

#include "weft/estimate.h"
#include "weft/mesh.h"
#include "weft/output.h"
#include "weft/printable.h"
#include "weft/simulation.h"

namespace weft::python {

namespace {

std::vector<Override> overrides_of(const py::dict& values) {
  std::vector<Override> overrides;
  for (const auto& [pointer, value] : values) {
    if (!py::isinstance<py::str>(pointer))
      throw py::type_error("values: a key is no str (JSON pointers such as \"/gravity/1\")");
    overrides.push_back({py::cast<std::string>(pointer), json_text(value)});
  }
  return overrides;
}

py::list tuples(const std::vector<Fault>& faults) {
  py::list list;
  for (const Fault& f : faults) list.append(py::make_tuple(f.place, f.what, f.allowed));
  return list;
}

// Of a scene without a file: they lie beside the working directory.
void read_meshes(SceneFile& file) {
  if (file.faults.empty()) load_meshes(file.scene, "", file.faults, file.notes);
  if (file.faults.empty()) file.faults = validate(file.scene);
}

// A scene that has left its file: meshes are no longer beside it.
Scene with_full_paths(SceneFile file) {
  const std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
  if (!file.path.empty()) use_full_paths(file.scene, folder.string());
  return std::move(file.scene);
}

SceneFile read_any(const py::object& scene, const py::dict& values) {
  const std::vector<Override> overrides = overrides_of(values);
  if (py::isinstance<py::dict>(scene)) {
    SceneFile file = read_scene_text(json_text(scene), overrides);
    read_meshes(file);
    return file;
  }
  const bool path = py::isinstance<py::str>(scene) || py::hasattr(scene, "__fspath__");
  if (!path)
    throw py::type_error("scene: a dict, a path, or the name of a shipped scene is needed, not " +
                         std::string(py::str(py::type::of(scene).attr("__name__"))));
  const auto name = py::cast<std::string>(py::module_::import("os").attr("fspath")(scene));
  return read_scene(name, overrides);
}

py::dict estimate_of(const py::object& scene, const py::dict& values) {
  const Estimate e = estimate(read(scene, values).scene);
  py::dict result;
  result["particles"] = e.particles;
  result["constraints"] = e.constraints;
  result["substeps"] = e.substeps;
  result["bytes"] = e.bytes;
  result["frame_seconds"] = e.frame_seconds;
  result["run_seconds"] = e.run_seconds();
  return result;
}

}  // namespace

std::string json_text(const py::handle& value) {
  const py::cpp_function plain([](const py::object& other) {
    if (py::hasattr(other, "tolist")) return other.attr("tolist")();
    if (py::hasattr(other, "__fspath__")) return other.attr("__fspath__")();
    throw py::type_error("a scene or study holds no " +
                         std::string(py::str(py::type::of(other).attr("__name__"))));
  });
  try {
    return py::cast<std::string>(py::module_::import("json").attr("dumps")(
        value, py::arg("default") = plain, py::arg("allow_nan") = false,
        py::arg("ensure_ascii") = false));
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError)) throw;
    throw py::value_error("a number is not finite, or a list holds itself");
  }
}

py::object json_value(const std::string& text) {
  return py::module_::import("json").attr("loads")(text);
}

SceneFile read(const py::object& scene, const py::dict& values) {
  SceneFile file = read_any(scene, values);
  if (file.faults.empty()) return file;
  for (Fault& fault : file.faults)
    if (!file.path.empty())
      fault.place = file.path + (fault.place.empty() ? "" : ":" + fault.place);
  throw SceneError(std::move(file.faults));
}

std::string lines(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& f : faults) {
    text += (text.empty() ? "" : "\n") + printable(f.place) + (f.place.empty() ? "" : ": ") +
            printable(f.what);
    if (!f.allowed.empty()) text += " (" + printable(f.allowed) + ")";
  }
  return text;
}

void register_errors(py::module_& module) {
  // The types live as long as the interpreter: translators may be called at its very end.
  static PyObject* const scene_error =
      py::exception<SceneError>(module, "SceneError", PyExc_ValueError).release().ptr();
  py::setattr(scene_error, "__doc__",
              py::str("A scene that cannot be simulated. `faults` lists (place, what, allowed) of "
                      "all that is wrong; places are JSON pointers, after the file's name."));
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const SceneError& e) {
      const py::object made = py::handle(scene_error)(lines(e.faults));
      made.attr("faults") = tuples(e.faults);
      PyErr_SetObject(scene_error, made.ptr());
    } catch (const WriteError& e) {
      PyErr_SetString(PyExc_OSError, (printable(e.path) + ": " + e.what()).c_str());
    }
  });
}

void register_scenes(py::module_& module) {
  module.def(
      "read_scene",
      [](const py::object& scene, const py::dict& values) {
        return json_value(write_scene_text(with_full_paths(read(scene, values))));
      },
      py::arg("scene"), py::arg("values") = py::dict(),
      R"(A scene as a dict: what differs from the defaults (see scene_schema()).

scene:  a dict, a path, or the name of a shipped scene
values: replaces single values, {"/solver/iterations": 20}
Raises SceneError with every fault.)");
  module.def(
      "check_scene",
      [](const py::object& scene, const py::dict& values) {
        return tuples(read_any(scene, values).faults);
      },
      py::arg("scene"), py::arg("values") = py::dict(),
      R"(All that is wrong with a scene, as a list of (place, what, allowed); [] when it is sound.)");
  module.def(
      "shipped_scenes",
      [] {
        py::dict all;
        for (const ShippedScene& s : shipped_scenes()) all[py::str(s.name)] = s.about;
        return all;
      },
      "The scenes that ship with Weft: {name: one line about it}.");
  module.def(
      "scene_schema", [] { return json_value(std::string(scene_schema())); },
      "The JSON Schema of scenes as a dict: names, ranges, defaults, units, a line of help each.");
  module.def("estimate", &estimate_of, py::arg("scene"), py::arg("values") = py::dict(),
             R"(What a run will need, roughly: a dict of particles, constraints, substeps (a frame),
bytes, frame_seconds and run_seconds (of the scene's own length; both on one thread).)");
}

}  // namespace weft::python
