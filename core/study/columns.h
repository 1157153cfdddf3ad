// What a row of a study's table holds.
#pragma once

#include <string>

#include "study/study.h"

namespace weft {

// "/cloth/ks" -> "cloth.ks"
std::string name_of_pointer(const std::string& pointer);

// A report with all that a run may measure.
nlohmann::ordered_json empty_report();

}  // namespace weft
