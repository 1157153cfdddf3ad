// The list schedule (list_schedule.h): from one event to the next.
#include "list_schedule.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <list>
#include <unordered_map>

namespace bench {
namespace {

using weft::physics::RowSpan;
using weft::physics::Section;
using weft::physics::Task;

constexpr double kNever = std::numeric_limits<double>::infinity();

// Which rows the caches hold, least recently used out first, and who wrote each last.
class RowCaches {
 public:
  explicit RowCaches(double bytes) : bytes_(bytes) {}

  struct Fetch {
    double from_memory = 0, from_others = 0;  // bytes
  };
  Fetch touch(RowSpan rows, std::size_t row_bytes, int worker) {
    Fetch fetch;
    for (int j = rows.begin; j < rows.end; ++j) {
      const auto [at, fresh] = held_.try_emplace(j);
      Held& row = at->second;
      if (fresh) {
        fetch.from_memory += bytes_ == kNever ? 0 : double(row_bytes);
        order_.push_front(j);
      } else {
        if (row.writer != worker) fetch.from_others += double(row_bytes);
        order_.splice(order_.begin(), order_, row.place);
      }
      row = {order_.begin(), worker};
      for (; double(order_.size()) * double(row_bytes) > bytes_ && order_.size() > 1;
           order_.pop_back())
        held_.erase(order_.back());
    }
    return fetch;
  }

 private:
  struct Held {
    std::list<int>::iterator place;
    int writer = 0;
  };
  double bytes_;
  std::list<int> order_;
  std::unordered_map<int, Held> held_;
};

struct Worker {
  double free_from = 0;
  int task = -1;
  double left = 0;  // ns, where nothing holds it up
  double rate = 0;  // bytes a ns that it then draws from memory
};

struct Ready {
  int task;
  double since;
  int by;  // the worker that made it so
};

// A section of tasks that workers share, the first of which opens it.
class SharedSection {
 public:
  SharedSection(const GraphSection& section, const Host& host, RowCaches& caches)
      : section_(section), host_(host), caches_(caches), graph_(section) {}

  // The others come at `others_from` at the earliest. Returns when the first goes on.
  double run(double begin, double others_from) {
    now_ = begin;
    workers_.assign(std::size_t(host_.workers), {others_from, -1, 0, 0});
    workers_[0].free_from = begin;
    for (std::size_t n = 0; n < section_.tasks.size(); ++n)
      if (graph_.waits[n] == 0) ready_.push_back({int(n), begin, 0});
    double end = begin;
    while (done_ < section_.tasks.size()) {
      hand_out();
      advance();
      for (std::size_t w = 0; w < workers_.size(); ++w)
        if (workers_[w].task >= 0 && workers_[w].left <= 0) {
          finish(w);
          end = std::max(end, now_ + (w == 0 ? 0 : host_.signal_ns));
        }
    }
    return end;
  }
  double memory_bytes() const { return memory_bytes_; }

 private:
  double visible(const Ready& r, std::size_t w) const {
    return r.since + (r.by == int(w) ? 0 : host_.signal_ns);
  }

  void hand_out() {
    for (std::size_t w = 0; w < workers_.size(); ++w) {
      if (workers_[w].task >= 0 || workers_[w].free_from > now_) continue;
      const auto r = std::find_if(ready_.begin(), ready_.end(),
                                  [&](const Ready& q) { return visible(q, w) <= now_; });
      if (r == ready_.end()) continue;
      const int task = r->task;
      ready_.erase(r);
      take(w, task);
    }
  }

  void take(std::size_t w, int n) {
    Worker& worker = workers_[w];
    const Task& task = section_.tasks[std::size_t(n)];
    const auto fetch = caches_.touch(task.rows, section_.row_bytes, int(w));
    memory_bytes_ += fetch.from_memory;
    worker.task = n;
    worker.left = host_.start_ns + fetch.from_others * host_.handover_ns +
                  std::max(task.nanoseconds, fetch.from_memory / host_.core_rate);
    worker.rate = worker.left > 0 ? fetch.from_memory / worker.left : 0;
  }

  // To the next moment at which a task ends, or an idle worker can take one.
  void advance() {
    double drawn = 0;
    for (const Worker& w : workers_)
      if (w.task >= 0) drawn += w.rate;
    const double slower = std::max(1.0, drawn / host_.rate);
    const auto pace = [&](const Worker& w) { return w.rate > 0 ? slower : 1.0; };
    double next = kNever;
    for (std::size_t w = 0; w < workers_.size(); ++w) {
      const Worker& worker = workers_[w];
      if (worker.task >= 0) {
        next = std::min(next, now_ + worker.left * pace(worker));
      } else {
        double seen = kNever;
        for (const Ready& r : ready_) {
          if (r.since >= seen) break;  // others are seen no sooner
          seen = std::min(seen, visible(r, w));
        }
        next = std::min(next, std::max({seen, worker.free_from, now_}));
      }
    }
    for (Worker& w : workers_) {
      if (w.task < 0) continue;
      // What ends now is done to the last bit.
      const bool ends = now_ + w.left * pace(w) <= next;
      w.left = ends ? 0 : w.left - (next - now_) / pace(w);
    }
    now_ = next;
  }

  void finish(std::size_t w) {
    const int task = workers_[w].task;
    workers_[w].task = -1;
    workers_[w].free_from = now_;
    ++done_;
    for (const int next : graph_.after[std::size_t(task)]) {
      if (--graph_.waits[std::size_t(next)] > 0) continue;
      if (workers_[w].task < 0)
        take(w, next);
      else
        ready_.push_back({next, now_, int(w)});
    }
  }

  const GraphSection& section_;
  const Host& host_;
  RowCaches& caches_;
  Successors graph_;
  std::vector<Worker> workers_;
  std::deque<Ready> ready_;
  std::size_t done_ = 0;
  double now_ = 0, memory_bytes_ = 0;
};

StageTime& stage_of(Forecast& forecast, const std::string& name) {
  for (StageTime& s : forecast.stages)
    if (s.stage == name) return s;
  return forecast.stages.emplace_back(StageTime{name, 0, 0, 0});
}

}  // namespace

Forecast foretell(const TaskGraph& graph, const Host& host) {
  Forecast forecast;
  RowCaches caches(host.cache_bytes);
  double gathered = 0;  // when the others stand by
  for (const GraphSection& s : graph.sections) {
    const double begin = forecast.ns;
    if (s.kind == Section::Kind::gathered) gathered = begin + host.wake_ns;
    for (const Task& t : s.tasks) stage_of(forecast, s.stage).work_ns += t.nanoseconds;
    if (s.kind == Section::Kind::alone) {
      forecast.ns += s.tasks.front().nanoseconds;
      stage_of(forecast, s.stage).alone_ns += s.tasks.front().nanoseconds;
    }
    if (s.kind == Section::Kind::shared) {
      SharedSection section(s, host, caches);
      const double others =
          s.standing_by ? std::max(gathered, begin + host.signal_ns) : begin + host.wake_ns;
      forecast.ns = section.run(begin, others);
      forecast.memory_bytes += section.memory_bytes();
    }
    if (!s.tasks.empty()) stage_of(forecast, s.stage).elapsed_ns += forecast.ns - begin;
  }
  return forecast;
}

}  // namespace bench
