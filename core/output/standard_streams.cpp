// Descriptors 0, 1 and 2, which new files take first.
#include "weft/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

namespace weft {

void occupy_standard_streams() {
  int descriptor = 0;
  do descriptor = ::open("/dev/null", O_RDONLY);
  while (descriptor >= 0 && descriptor <= STDERR_FILENO);
  if (descriptor > STDERR_FILENO) ::close(descriptor);
}

}  // namespace weft
