// The viewer's file of keys: any bytes give bindings that have names, or reasons.
#include "window/keys.h"

#include "target.h"

// The target has no window; nothing here asks for one.
bool weft::viewer::Window::key_down(int) const {
  return false;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(fuzz::text_of(data, size));
  weft::viewer::Keys keys;
  for (const std::string& wrong : keys.read(file.path())) fuzz::require(!wrong.empty());
  for (std::size_t a = 0; a < weft::viewer::kActions; ++a)
    fuzz::require(!keys.names_of(static_cast<weft::viewer::Action>(a)).empty());
  return 0;
}
