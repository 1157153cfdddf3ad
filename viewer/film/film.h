// A film of the view, at 30 pictures for a second of the simulation: through ffmpeg to MP4, or as
// numbered PNG files where there is no ffmpeg. An MP4 takes its name when it is whole.
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "picture/images.h"
#include "weft/output.h"

namespace weft::viewer {

class Film {
 public:
  static constexpr double kRate = 30;  // pictures per second

  // Width and height are even. `base`: the file without extension; `besides`: a file that it is not,
  // "" = any. `waits`: the scene waits for the start [s]; else it runs on, and the film begins where it is.
  // Throws Failure when the film cannot be written there.
  Film(const std::string& base, const std::string& besides, int width, int height, double start,
       bool waits);
  ~Film();  // a film that is not finished leaves no MP4
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  // How many pictures are due at a time of the simulation [s]: none before the start. When it has gone back,
  // the film goes on from there.
  int due(double time);
  // The time of the simulation at which the next picture is due [s].
  double next() const { return start_ + static_cast<double>(count_) / kRate; }
  // Adds the picture so many times. Throws Failure when it cannot be written.
  void add(const Picture& picture, int times);
  // Throws Failure when the film has not become whole.
  void finish();
  // Where finish() leaves it.
  const std::string& path() const { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* pipe) const { ::pclose(pipe); }
  };
  std::string base_, path_;
  std::optional<OutputFile> file_;  // MP4
  int width_, height_;
  double start_, last_;  // s, of the first picture and of the newest
  bool waits_;
  long count_ = 0;
  std::unique_ptr<std::FILE, Close> pipe_;
};

// The first of base.ext, base-2.ext, … that is not there yet, and is not `besides` ("" = any).
std::string free_name(const std::string& base, const std::string& extension,
                      const std::string& besides);
// The path from the root on, for messages.
std::string full_path(const std::string& path);
// Whether two paths mean one file, be it there or not.
bool same_file(const std::string& a, const std::string& b);

}  // namespace weft::viewer
