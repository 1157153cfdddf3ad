// weft._weft: the library's face to Python. The package's __init__.py says what is public.
#include "scenes.h"
#include "simulation.h"
#ifdef WEFT_STUDY
#include "study.h"
#endif

PYBIND11_MODULE(_weft, module) {
  weft::python::register_errors(module);
  weft::python::register_scenes(module);
  weft::python::register_simulation(module);
  weft::python::register_batch(module);
#ifdef WEFT_STUDY
  weft::python::register_study(module);
#endif
  module.attr("__version__") = WEFT_VERSION;
}
