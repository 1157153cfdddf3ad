// Graphs of tasks (task_graph.h).
#include "task_graph.h"

#include <algorithm>
#include <unordered_map>

namespace bench {
namespace {

bool alike(const TaskGraph& a, const TaskGraph& b) {
  return std::equal(a.sections.begin(), a.sections.end(), b.sections.begin(), b.sections.end(),
                    [](const GraphSection& p, const GraphSection& q) {
                      return p.kind == q.kind && p.stage == q.stage &&
                             p.standing_by == q.standing_by && p.tasks.size() == q.tasks.size() &&
                             p.dependences.size() == q.dependences.size();
                    });
}

double path_of(const GraphSection& section) {
  Successors graph(section);
  std::vector<double> end(section.tasks.size(), 0);
  std::vector<int> ready;
  for (std::size_t n = 0; n < section.tasks.size(); ++n)
    if (graph.waits[n] == 0) ready.push_back(int(n));
  double longest = 0;
  while (!ready.empty()) {
    const auto n = std::size_t(ready.back());
    ready.pop_back();
    end[n] += section.tasks[n].nanoseconds;
    longest = std::max(longest, end[n]);
    for (const int next : graph.after[n]) {
      end[std::size_t(next)] = std::max(end[std::size_t(next)], end[n]);
      if (--graph.waits[std::size_t(next)] == 0) ready.push_back(next);
    }
  }
  return longest;
}

}  // namespace

Successors::Successors(const GraphSection& section)
    : after(section.tasks.size()), waits(section.tasks.size(), 0) {
  std::unordered_map<int, int> place;
  for (std::size_t n = 0; n < section.tasks.size(); ++n) place[section.tasks[n].number] = int(n);
  for (const weft::physics::Dependence& d : section.dependences) {
    const int next = place.at(d.after);
    after[std::size_t(place.at(d.before))].push_back(next);
    ++waits[std::size_t(next)];
  }
}

double TaskGraph::work_ns() const {
  double sum = 0;
  for (const GraphSection& s : sections)
    for (const weft::physics::Task& t : s.tasks) sum += t.nanoseconds;
  return sum;
}

double TaskGraph::path_ns() const {
  double sum = 0;
  for (const GraphSection& s : sections) sum += path_of(s);
  return sum;
}

void TaskGraph::take_shorter(const TaskGraph& again) {
  if (!alike(*this, again)) {
    if (again.work_ns() < work_ns()) *this = again;
    return;
  }
  for (std::size_t s = 0; s < sections.size(); ++s)
    for (std::size_t n = 0; n < sections[s].tasks.size(); ++n) {
      double& ns = sections[s].tasks[n].nanoseconds;
      ns = std::min(ns, again.sections[s].tasks[n].nanoseconds);
    }
}

TaskGraph graph_of(const weft::physics::TaskRecord& record) {
  TaskGraph graph;
  graph.sections.reserve(record.sections().size());
  for (const weft::physics::Section& s : record.sections()) {
    const auto tasks = record.tasks(s);
    const auto dependences = record.dependences(s);
    graph.sections.push_back({s.kind,
                              s.stage,
                              s.standing_by,
                              s.row_bytes,
                              {tasks.begin(), tasks.end()},
                              {dependences.begin(), dependences.end()}});
  }
  return graph;
}

}  // namespace bench
