// All files of a run, as one.
#include "files.h"

#include "failure.h"
#include "weft/interrupt.h"
#include "weft/printable.h"

namespace weft::cli {

void refuse_clashes(const FileNames& names, const std::string& scene, std::int64_t samples) {
  std::vector<NamedFile> outputs,
      inputs{{"standard output", "/dev/stdout"}, {"standard error", "/dev/stderr"}};
  if (!names.replay.empty()) inputs.push_back({"--replay", names.replay});
  if (!scene.empty()) inputs.push_back({"SCENE", scene});
  if (!names.animation.empty())
    for (const std::string& file :
         animation_files(names.animation, samples, {names.record, names.dump, names.report}))
      outputs.push_back({"--export", file});
  for (const auto& [option, path] :
       {std::pair{"--record", names.record}, {"--dump", names.dump}, {"--report", names.report}})
    if (!path.empty()) outputs.push_back({option, path});
  if (const std::optional<Fault> fault = find_clash(outputs, inputs))
    throw Failure{kBadCommandLine, {*fault}};
}

Files::Files(const FileNames& names, const Simulation& simulation, std::int64_t frames,
             Recordings& recordings)
    : recordings_(recordings) {
  if (!names.animation.empty()) {
    animation_ = open_animation(names.animation, simulation.view(), frames + 1);
    animation_->append(simulation.view());  // the start is its first sample
  }
  recordings_.start(simulation);
  if (!names.dump.empty()) dump_.emplace(names.dump);
  if (!names.report.empty()) report_.emplace(names.report);
}

void Files::frame(const Simulation& simulation) {
  recordings_.after_frame(simulation);
  if (animation_) animation_->append(simulation.view());
}

void Files::finish(const Simulation& simulation, const Report& report) {
  const bool whole = simulation.status().ok;
  if (dump_ && whole) dump_->write(dump_bytes(simulation.positions()));
  if (report_) report_->write(to_json(report));
  finish(whole, true);
}

void Files::finish_within_frame() {
  finish(false, false);
}

void Files::finish(bool dump, bool report) {
  dumped_ = dump_ && dump, reported_ = report_ && report;
  Recorder* const recorder = recordings_.recorder();
  if (animation_) animation_->complete();
  if (recorder != nullptr) recorder->complete();
  if (dumped_) dump_->complete();
  if (reported_) report_->complete();

  const Uninterrupted uninterrupted;
  const auto commit = [&](auto& file, const std::string& name) {
    file.commit();
    written_.push_back(printable(name));
  };
  if (animation_) commit(*animation_, animation_->written());
  if (recorder != nullptr) commit(*recorder, recorder->path());
  if (dumped_) commit(*dump_, dump_->path());
  if (reported_) commit(*report_, report_->path());
}

std::vector<std::string> Files::missing() const {
  std::vector<std::string> names;
  if (dump_ && !dumped_) names.push_back(printable(dump_->path()));
  if (report_ && !reported_) names.push_back(printable(report_->path()));
  return names;
}

}  // namespace weft::cli
