// The folder in which files wait until they take their names: hidden, beside them, and gone at the
// end. Its writer holds a lock while it lives. A process that is killed leaves such a folder behind;
// the next that writes to the same place finds it unlocked and removes it.
#pragma once

#include <string>

namespace weft {

class Staging {
 public:
  // Makes one in this folder, and removes those that were left there. Throws std::system_error.
  explicit Staging(std::string folder);
  // Removes it with all files that are still in it.
  ~Staging();
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  const std::string& folder() const { return folder_; }  // that it is in
  // A path for another file in it.
  std::string next();

 private:
  bool make();
  void remove();
  void release_slot();

  std::string folder_, path_;
  int lock_ = -1;  // descriptor
  int slot_ = -1;  // what a signal handler knows of it
  unsigned files_ = 0;
};

}  // namespace weft
