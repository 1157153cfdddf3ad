// What frames find to be worse than what was asked for: told once each, by notes of the plan.
#pragma once

#include <string>
#include <vector>

#include "physics/contact/pinched.h"
#include "physics/frame/cloth_step.h"
#include "physics/frame/energy_guard.h"
#include "physics/frame/sheet_contact.h"
#include "physics/frame/sleeping.h"
#include "physics/frame/time_step.h"

namespace weft::physics {

// Adds a note that is not among them yet.
void add_once(std::vector<std::string>& notes, const std::string& note);

// A frame that has been accepted.
struct EndedFrame {
  std::int64_t number;  // from 1 on
  double time;          // s, at its end
  const TimeStep& step;
  const Cloths& cloths;
  Threads& threads;
  const Sleeping* sleeping;     // or null
  const SheetContact* contact;  // or null
  const EnergyGuard& energy;
  bool driven;  // something but gravity and contact between sheets did work
};

class FrameNotes {
 public:
  explicit FrameNotes(const Scene& scene)
      : overlong_(scene.cloths.size()),
        stretched_(scene.cloths.size()),
        pinched_(scene.cloths.size()),
        pierced_(scene.cloths.size()),
        pinched_search_(scene) {}

  // The energy that is there is counted anew.
  void begin_anew(const Cloths& cloths, double time, const TimeStep& step);
  // Looks at a frame, and adds what it finds. What is read only when somebody asks waits for tell(): frames
  // allocate nothing for it.
  void look(const EndedFrame& frame, std::vector<std::string>& notes);
  // Adds strain limits that did not hold, and seams that are open after so many frames, in place of what was
  // told of them before.
  void tell(const Cloths& cloths, std::int64_t frames, std::vector<std::string>& notes);
  void keep(Keeper& keeper);

 private:
  // The frames at whose end a cloth was longer somewhere than its strain limit allows.
  struct Overlong {
    std::int64_t first = 0, count = 0;
    std::int64_t worst = 0;  // the one with the greatest strain
    double strain = 0;
  };
  void check_strain_limits(const EndedFrame& frame);
  void note_clamps(const EndedFrame& frame, std::vector<std::string>& notes);
  void note_stretch(const EndedFrame& frame, std::vector<std::string>& notes);
  void note_pressed(const EndedFrame& frame, std::vector<std::string>& notes);
  void note_pierced(const EndedFrame& frame, std::vector<std::string>& notes);
  void note_pinched(const EndedFrame& frame, std::vector<std::string>& notes);
  void note_left_strain(const EndedFrame& frame, std::vector<std::string>& notes);
  void note_shaking(const EndedFrame& frame, std::vector<std::string>& notes);
  void count_energy(const Cloths& cloths, double time, const TimeStep& step);
  void note_heating(const EndedFrame& frame, std::vector<std::string>& notes);

  std::vector<Overlong> overlong_;       // of every cloth
  std::vector<std::uint8_t> stretched_;  // of every cloth: told of
  std::vector<std::uint8_t> pinched_;    // the same
  std::vector<std::uint8_t> pierced_;    // the same
  PinchedSearch pinched_search_;
  int pressed_ = 0;  // frames in which sheets were pressed, one after another
  bool clamps_ = false, left_strain_ = false, shaking_ = false, heating_ = false;
  // J; the energy as it was counted anew, at a time [s], and the greatest motion since, by forces.
  double first_energy_ = 0, counted_at_ = 0, greatest_motion_ = 0;
  bool driven_ = false;  // in any frame since the energy was counted anew
  std::vector<std::string> told_;
};

}  // namespace weft::physics
