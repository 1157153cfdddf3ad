// Whole files written at once: the dump of final positions and the report.
#include "output/bytes.h"
#include "weft/output.h"

namespace weft {

std::string dump_bytes(std::span<const double> positions) {
  std::string bytes;
  bytes.reserve(positions.size_bytes());
  for (const double value : positions) append_little_endian(bytes, value);
  return bytes;
}

void write_dump(const std::string& path, std::span<const double> positions) {
  OutputFile file(path);
  file.write(dump_bytes(positions));
  file.commit();
}

void write_report(const std::string& path, const Report& report) {
  OutputFile file(path);
  file.write(to_json(report));
  file.commit();
}

}  // namespace weft
