// A study: one scene, run again and again with other values (docs/studies.md).
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "weft/simulation.h"

namespace weft {

// What is wrong with a study; places are JSON pointers into its file.
struct StudyError : std::invalid_argument {
  explicit StudyError(std::vector<Fault> found);
  std::vector<Fault> faults;
};

// A run was given up because keep_going() said no.
struct Abandoned {};

// A column of the table, within its rows.
struct Column {
  enum class Kind { whole, number, text };
  std::string name;
  Kind kind = Kind::number;  // uint64, float64, UTF-8 of `bytes`, filled up with zeros
  std::size_t bytes = 8;
  std::size_t offset = 0;
};

// How positions lie in the file: (runs, samples, particles, 3) float32, in chunks of one run, some samples
// and as many particles as the scene itself has. Where a run has fewer samples or particles: NaN.
struct Chunks {
  std::vector<std::int64_t> frames;  // of the samples, increasing; none: positions are not kept
  std::size_t samples = 1;           // of a chunk
  std::size_t particles = 1;         // of a chunk
  std::size_t values() const { return samples * particles * 3; }
};

// What came of one run, ready for the file.
struct Record {
  struct Chunk {
    std::uint32_t sample = 0, particle = 0;  // which chunk along each axis
    std::string bytes;                       // shuffled and deflated, as HDF5's filters would
  };
  std::uint64_t run = 0, particles = 0;
  std::string row;
  std::vector<Chunk> chunks;
};
std::string to_bytes(const Record& record);
// Throws std::invalid_argument for bytes that are none.
Record record_of(std::string_view bytes);

class Study {
 public:
  // `json`: the text of a STUDY file; a scene that it names is looked for in `folder`, then among the
  // shipped scenes. Throws StudyError.
  Study(std::string_view json, const std::string& folder);

  std::uint64_t runs() const { return runs_; }
  // The study with its scene inside: what Study() makes the same study of, anywhere.
  const std::string& text() const { return text_; }
  const std::vector<Column>& columns() const { return columns_; }
  std::size_t row_bytes() const;
  const Chunks& chunks() const { return chunks_; }
  // Corners of the scene's triangles, for whoever reads the positions.
  const std::vector<std::uint32_t>& triangles() const { return triangles_; }

  // Simulates one run. What goes wrong in it is in its row, in the column `status`; throws Abandoned
  // alone. keep_going() is asked before every frame.
  Record run(std::uint64_t run, int threads, const std::function<bool()>& keep_going) const;

 private:
  using Json = nlohmann::ordered_json;
  struct Parameter {
    std::string pointer, name;
    std::vector<Json> values;  // none: drawn
    double from = 0, to = 0;
    bool log = false, whole = false, text = false;
  };
  struct Reader;
  class Sampler;

  std::vector<Json> values_of(std::uint64_t run) const;
  void add_columns();
  void put(std::string& row, std::size_t column, const Json& value) const;
  std::string simulate(const std::vector<Json>& values, int threads,
                       const std::function<bool()>& keep_going, Record& record) const;

  std::string text_, scene_;
  std::uint64_t runs_ = 1, seed_ = 1, drawn_ = 1;
  std::vector<Parameter> parameters_;
  std::vector<double> points_;  // of the draws
  std::size_t dimensions_ = 0;
  std::vector<std::string> measures_;  // JSON pointers into the report
  std::int64_t frames_ = 0;            // 0: as long as the scene says
  std::vector<Column> columns_;
  Chunks chunks_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace weft
