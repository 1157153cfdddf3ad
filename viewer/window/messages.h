// What the window has to tell: news that fade, and faults that stay until they are mended or
// dismissed.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace weft::viewer {

class Messages {
 public:
  struct News {
    std::string text;
    double until = 0;  // s
    bool bad = false;
  };

  void tell(const std::string& text, double now);
  void warn(const std::string& text, double now);
  // The fault of a topic; "" ends it.
  void fault(const std::string& topic, const std::string& text);

  void forget(double now);
  void dismiss();  // all there is now
  const std::vector<News>& news() const { return news_; }
  const std::map<std::string, std::string>& faults() const { return faults_; }

 private:
  void add(const std::string& text, double until, bool bad);

  std::vector<News> news_;
  std::map<std::string, std::string> faults_, dismissed_;
};

}  // namespace weft::viewer
