// Memory for arrays (aligned_array.h).
#include "physics/step/aligned_array.h"

#include <cstring>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace weft::physics {
namespace {

constexpr std::size_t kLine = 64, kHugePage = std::size_t(2) << 20;

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  const bool huge = bytes >= kHugePage;
  const std::size_t boundary = huge ? kHugePage : kLine;
  const std::size_t room = (bytes + boundary - 1) / boundary * boundary;
  void* const memory = room < bytes ? nullptr : std::aligned_alloc(boundary, room);
  if (!memory) throw std::bad_alloc();
#if defined(__linux__)
  // Before the first byte is written. Where the system declines, small pages do.
  if (huge) (void)madvise(memory, room, MADV_HUGEPAGE);
#endif
  return std::memset(memory, 0, room);
}

}  // namespace weft::physics
