// weft.study's own half in C++.
#pragma once

#include <pybind11/pybind11.h>

namespace weft::python {

void register_study(pybind11::module_& module);

}  // namespace weft::python
