// News and faults.
#include "window/messages.h"

#include <cstdio>
#include <utility>

namespace weft::viewer {

void Messages::add(const std::string& text, double until, bool bad) {
  if (!news_.empty() && news_.back().text == text) {
    news_.back().until = until;
    return;
  }
  if (bad) std::fprintf(stderr, "weft-viewer: %s\n", text.c_str());
  news_.push_back({text, until, bad});
}

void Messages::tell(const std::string& text, double now) {
  add(text, now + 4, false);
}

void Messages::warn(const std::string& text, double now) {
  add(text, now + 12, true);
}

void Messages::fault(const std::string& topic, const std::string& text) {
  if (text.empty()) {
    faults_.erase(topic);
    dismissed_.erase(topic);
    return;
  }
  if (const auto known = dismissed_.find(topic); known != dismissed_.end() && known->second == text)
    return;
  std::string& known = faults_[topic];
  if (known != text) std::fprintf(stderr, "weft-viewer: %s\n", text.c_str());
  known = text;
}

void Messages::dismiss() {
  news_.clear();
  for (auto& [topic, text] : std::exchange(faults_, {})) dismissed_[topic] = text;
}

void Messages::forget(double now) {
  std::erase_if(news_, [&](const News& n) { return n.until < now; });
}

}  // namespace weft::viewer
