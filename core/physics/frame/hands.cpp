// Stages that come and go with a hand (hands.h).
#include "physics/frame/hands.h"

#include <algorithm>
#include <utility>

#include "physics/step/keeper.h"

namespace weft::physics {

bool Hands::act() const {
  return grab_ || std::any_of(carried_.begin(), carried_.end(), [](const Carry* c) { return c; });
}

double Hands::grab(int cloth, Particles::Place particle, const Vec3& target, double stiffness) {
  if (!grab_) {
    ClothStep& step = *cloths_[std::size_t(cloth)];
    auto stage = std::make_unique<Grab>(step.parts());
    grab_ = stage.get();
    grabbed_ = cloth;
    step.add_stage(std::move(stage));
  }
  const double stored = grab_->holds(particle) ? grab_->energy() : 0;
  grab_->place = particle;
  grab_->target = target;
  grab_->stiffness = stiffness;
  return std::max(0.0, grab_->energy() - stored);
}

void Hands::release() {
  if (grab_) cloths_[std::size_t(grabbed_)]->remove_stage(grab_);
  grab_ = nullptr;
}

double Hands::carry(int cloth, const Vec3& velocity, double time) {
  Carry*& stage = carried_[std::size_t(cloth)];
  if (!stage) {
    ClothStep& step = *cloths_[std::size_t(cloth)];
    auto made = std::make_unique<Carry>(step.parts());
    stage = made.get();
    step.add_stage(std::move(made));
  }
  stage->begin(time, velocity);
  return stage->speed();
}

void Hands::put_down(int cloth) {
  if (Carry* stage = std::exchange(carried_[std::size_t(cloth)], nullptr))
    cloths_[std::size_t(cloth)]->remove_stage(stage);
}

void Hands::let_go() {
  release();
  for (std::size_t c = 0; c < carried_.size(); ++c) put_down(int(c));
}

void Hands::begin_anew(double time) {
  for (Carry* carry : carried_)
    if (carry) carry->begin_anew(time);
}

void Hands::keep(Keeper& keeper) {
  if (keeper.puts_back()) let_go();
  for (std::size_t c = 0; c < carried_.size(); ++c) {
    bool carried = carries(c);
    keeper(carried);
    if (carried && !carries(c)) carry(int(c), {}, 0);
  }
  int cloth = grabbed();
  keeper(cloth);
  if (cloth >= 0 && !grab_) grab(cloth, {0, 0}, {}, 0);
}

void Hands::tell(EnergyGuard& guard) const {
  for (const Carry* carry : carried_)
    if (carry) guard.drive(carry->speed());
  if (grab_) guard.put_in(grab_->energy());
}

}  // namespace weft::physics
