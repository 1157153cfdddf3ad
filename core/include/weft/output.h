// Simulation -> files: final positions, whole animations, and the rule that every file appears
// complete or not at all. A file is written under a temporary name in its own directory and takes
// its real name at the end; whatever ends a run early, no half-written file is left behind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "weft/simulation.h"

namespace weft {

// A file could not be written: what() says why, `path` which one.
struct WriteError : std::runtime_error {
  WriteError(std::string file, const std::string& why);
  std::string path;
};

// A file that takes its name when commit() is called; destroyed before, it leaves nothing. Links are
// followed. A file that replaces another keeps that one's mode, and its owner where that is allowed.
// Devices, pipes and what the process has open itself (/dev/stdout) are written directly. Every
// function throws WriteError.
//
// Until then the file lies in a hidden folder beside its target, .weft-….tmp. A process that is killed
// (SIGKILL) leaves that folder; the next OutputFile in the same place removes it.
class OutputFile {
 public:
  // Opens the temporary file: a path that cannot be written is found here, before any work.
  explicit OutputFile(std::string path);
  // The same, in the hidden folder of another that is not committed yet: for many files of one result.
  OutputFile(std::string path, const OutputFile& beside);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  OutputFile& operator=(OutputFile&&) = delete;

  const std::string& path() const { return path_; }
  // Where the bytes are until commit(): for another program that writes them.
  std::string temporary() const;
  void write(std::string_view bytes);
  // Replaces bytes already written, `offset` from the start; writing goes on at the end.
  void overwrite(std::int64_t offset, std::string_view bytes);
  // Nothing more is written; what is left for commit() is the name. For several files that appear
  // together: complete() all, then commit() all. `store`: returns when the disk has the bytes, so that
  // not even a power cut leaves a name without them; without, the caller sees to that for many at once.
  void complete(bool store = true);
  void commit();

 private:
  struct Stream;
  OutputFile(std::string path, const OutputFile* beside);
  void open_staging(const OutputFile* beside);

  std::string path_;
  std::unique_ptr<Stream> stream_;
};

// Removes the temporary files of the process's first 64 OutputFiles that are open. Safe in a signal
// handler that then ends the process; of no use elsewhere.
void remove_temporaries() noexcept;

// Positions (Simulation::positions) as raw little-endian float64 x,y,z, in scene order.
std::string dump_bytes(std::span<const double> positions);

// Opens, writes and commits in one go.
void write_dump(const std::string& path, std::span<const double> positions);
void write_report(const std::string& path, const Report& report);

// A file, or a sequence of files, that grows by one sample per append(). Memory does not grow with
// the number of samples.
//
//   auto animation = weft::open_animation("run.pc2", simulation.view());
//   animation->append(simulation.view());            // the start
//   while (...) { simulation.advance_frame(); animation->append(simulation.view()); }
//   animation->finish();
class Animation {
 public:
  virtual ~Animation() = default;
  // Throws WriteError; throws std::invalid_argument for a view of another particle count.
  virtual void append(const View& view) = 0;
  // Makes what was appended so far valid under its real name: complete(), then commit().
  void finish();
  // The two steps of finish(), as those of OutputFile. No file changes before commit(). At every
  // moment of it a .gltf matches its .bin; of a sequence each file is whole.
  virtual void complete() = 0;
  virtual void commit() = 0;
  // What commit() leaves: "run.pc2", "run_0000.obj … run_0300.obj".
  virtual std::string written() const = 0;
};

// The animation formats, by file extension:
//   .pc2  point cache that Blender's Mesh Cache modifier reads (with its own axes, on the imported .obj); one float32
//         x,y,z per particle in scene order and sample
//   .obj  numbered sequence run_0000.obj, run_0001.obj, …: one object per cloth, of quads of a grid, of
//         triangles of a mesh or once it is torn, with texture coordinates
//   .mdd  point cache as .pc2, big-endian, with the time of every sample
//   .glb, .gltf (with a .bin beside it)  meshes with texture coordinates and a morph target for every sample;
//         refuses cloth that tears, more than 4000 samples, and more than 1 GiB of positions
//   .usda  USD as text: meshes with texture coordinates, their points as time samples; refuses cloth that tears
std::vector<std::string> animation_extensions();

// Opens an animation of the particles of `first` (nothing is appended yet). Throws WriteError when
// it cannot be written, or `samples` would not fit the format (0: nobody knows how many are to come),
// and std::invalid_argument when the extension is not one of the above.
std::unique_ptr<Animation> open_animation(const std::string& path, const View& first,
                                          std::int64_t samples = 0);

// The files that an animation of so many samples (0: any number) may write. Of a sequence, which may be
// endless: those that are there already, and those among `others`.
std::vector<std::string> animation_files(const std::string& path, std::int64_t samples,
                                         const std::vector<std::string>& others);

// A file as a command line names it.
struct NamedFile {
  std::string option;  // "--dump"
  std::string path;
};

// The first output that another output or an input would be overwritten by, or that it is itself:
// the same path once links are followed, or one file under two names (hard links). Its place is the
// path. None where all differ; devices, pipes and standard output may be named any number of times.
std::optional<Fault> find_clash(const std::vector<NamedFile>& outputs,
                                const std::vector<NamedFile>& inputs);

}  // namespace weft
