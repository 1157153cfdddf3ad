// Results of a study as an HDF5 file: /runs, a table with a row for each run; /positions and /frames where
// positions are kept; /triangles. The same records make the same bytes.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "study/study.h"
#include "weft/output.h"

namespace weft {

// The runs K, K + N, K + 2 N … of a study (from 0).
struct Shard {
  std::uint64_t number = 0, of = 1;
  bool has(std::uint64_t run) const { return run % of == number; }
  std::uint64_t runs(const Study& study) const { return (study.runs() + of - 1 - number) / of; }
};

// A record that lies somewhere else.
struct Stored {
  std::uint64_t run = 0, particles = 0, bytes = 0;
  std::function<Record()> read;
};

// Writes the records, in order of their runs, to a file that is not committed yet. Throws WriteError.
void write_table(OutputFile& file, const Study& study, Shard shard,
                 const std::vector<Stored>& records);

// A file that write_table() made. Throws StudyError.
class TableFile {
 public:
  explicit TableFile(const std::string& path);
  ~TableFile();
  TableFile(TableFile&&) noexcept;

  const std::string& study() const { return study_; }  // Study::text()
  Shard shard() const { return shard_; }
  // All its records; they read from this file, which must live as long.
  std::vector<Stored> records(const Study& study) const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
  std::string path_, study_;
  Shard shard_;
};

}  // namespace weft
