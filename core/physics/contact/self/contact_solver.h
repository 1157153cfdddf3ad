// Contacts of N bodies, solved together: impulses on displacements (kernels/contact_packets.cpp).
//
// Contacts are given in an order of their own, which does not depend on how they were found. Each gets the
// first colour that no contact before it has on any of its bodies; those of a colour share no body, go
// into packets of 16 and may be solved in any order. Colours follow each other (Gauss-Seidel). So the
// result is the same for any threads. Impulses begin as they were in the run before, times the square of
// how much longer the interval is: that is what a steady load asks for.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "physics/contact/self/body_answer.h"
#include "physics/kernels/contact.h"
#include "physics/step/aligned_array.h"
#include "physics/step/threads.h"

namespace weft::physics {

// From one run of contact to the next.
struct ContactInterval {
  double dt;        // s
  int substeps;     // impulses act in the last of them
  double gravity;   // m/s²
  double time = 0;  // s, at its end
  double seconds() const { return substeps * dt; }
};

template <int N>
struct Contact {
  std::uint64_t key;  // the same two things have the same; contacts come in its order
  std::array<std::int32_t, N> body;
  std::array<float, N> share;   // of four; two bodies have 1 and -1,
  std::array<float, 3> normal;  // and are measured by their places, but for held
  float distance, held;         // m
  float friction;
};

template <int N>
class ContactSolver {
 public:
  // `answer`, of what lies on the bodies of the scene, lives longer.
  ContactSolver(std::size_t bodies, BodyAnswer& answer, const ContactKernels<N>& kernels);

  // To be filled before each run.
  std::vector<Contact<N>>& contacts() { return contacts_; }
  // Displacements in an interval, from these places to where things are now. Returns how much of the distance held is
  // missing at most, after all.
  float solve(const Place* place, const Place* now, const Displacement* moved,
              const ContactInterval& interval, Threads& threads);

  // What comes of it: bodies, each once, with the displacement by which their velocities change, and
  // what their positions alone do.
  const std::vector<std::int32_t>& touched() const { return touched_; }
  Displacement& change(std::int32_t body) { return change_[std::size_t(body)]; }
  const Displacement& lift(std::int32_t body) const { return lift_[std::size_t(body)]; }
  // One more body is touched, unless it is already.
  void touch(std::int32_t body, float inverse_mass);
  // Nothing is touched any more.
  void clear();
  // Contacts begin without impulses.
  void forget() { impulses_.clear(); }
  // Impulses that contacts begin with.
  void keep(Keeper& keeper);
  std::int64_t sweeps() const { return sweeps_; }
  std::size_t bytes() const;

 private:
  using Packet = ContactPacket<N>;
  struct Impulse {
    std::uint64_t key;
    float pressed, rubbed[3];
  };
  static constexpr int kColours = 64;  // beyond, each contact has a packet of its own

  void colour();
  void fill(double seconds);
  void put(const Contact<N>& contact, std::int32_t at);
  void begin_with(std::size_t contact, const Impulse& impulse, float scale);
  void keep_impulses();
  template <class Work>
  void for_each_part(const Work& work);
  float sweep(Displacement* change, float enough, int most);
  float separate(float most);
  void settle(int substeps);

  BodyAnswer& answer_;
  const ContactKernels<N>& kernels_;
  const std::size_t bodies_;
  std::vector<Contact<N>> contacts_;
  std::vector<std::uint64_t> colours_;  // of every body, a bit each
  std::vector<std::int32_t> touched_;
  std::vector<std::uint8_t> is_touched_;
  std::vector<std::uint8_t> colour_;  // of every contact
  std::vector<std::int32_t> place_;   // of every contact: packet * 16 + lane
  std::vector<Packet> packets_;
  std::vector<std::int32_t> begin_;          // of every colour's packets
  std::vector<Displacement> change_, lift_;  // of every body, and of 16 that stand for none
  std::vector<Impulse> impulses_;            // of the run before, in order of their keys
  std::vector<float> corrections_;           // of every packet that begins a part
  double seconds_ = 1;
  const Place* places_ = nullptr;
  const Displacement* moved_ = nullptr;
  Threads* threads_ = nullptr;
  float held_ = 0;  // m, the greatest
  std::int64_t sweeps_ = 0;
};

extern template class ContactSolver<2>;
extern template class ContactSolver<4>;

}  // namespace weft::physics
