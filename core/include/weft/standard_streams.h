// Standard input, output and error of a program.
#pragma once

namespace weft {

// A program may be started without some of them; then none of its files must take their place, to which
// messages go. Writing to what is missing still fails.
void occupy_standard_streams();

}  // namespace weft
