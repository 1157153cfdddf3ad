// Contact beside the substeps (sheet_contact.h).
#include "physics/frame/sheet_contact.h"

#include <cmath>

#include "physics/model/path.h"
#include "physics/step/keeper.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr std::int64_t kManyParticles = 8192;  // for whose contact threads stand by all frame

}  // namespace

std::unique_ptr<SheetContact> SheetContact::make(const Scene& scene, const Cloths& cloths,
                                                 const KernelTable& kernels) {
  std::vector<ClothModel*> models = models_of(cloths);
  auto contact = SelfContact::make(scene, models, kernels);
  if (!contact) return nullptr;
  return std::unique_ptr<SheetContact>(new SheetContact(
      scene, std::move(models), kernels, std::move(contact), cloths.front()->sheets_meet_first()));
}

SheetContact::SheetContact(const Scene& scene, std::vector<ClothModel*> models,
                           const KernelTable& kernels, std::unique_ptr<SelfContact> contact,
                           bool meets_first)
    : scene_(scene),
      models_(std::move(models)),
      kernels_(kernels),
      contact_(std::move(contact)),
      untangle_(std::make_unique<Untangle>(scene, models_)),
      meets_first_(meets_first) {}

void SheetContact::begin_anew() {
  contact_ = SelfContact::make(scene_, models_, kernels_);
  untangle_ = std::make_unique<Untangle>(scene_, models_);
}

void SheetContact::restart() {
  contact_->restart();
  until_ = 1;
}

void SheetContact::save() {
  untangle_at_start_.clear();
  if (!untangle_->due()) return;
  Keeper keeper;
  untangle_->keep(keeper);
  untangle_at_start_ = keeper.take();
}

void SheetContact::go_back() {
  contact_->go_back();
  if (untangle_at_start_.empty()) return;
  Keeper keeper(untangle_at_start_);
  untangle_->keep(keeper);
}

void SheetContact::keep(Keeper& keeper) {
  contact_->keep(keeper, meets_first_);
  untangle_->keep(keeper);
  keeper(until_);
  keeper(runs_);
}

// Surfaces begin with what does not cross; what does comes apart first.
void SheetContact::begin_frame(Threads& threads) {
  const bool drawn = contact_->surfaces() && untangle_->look_at_seams();
  if (contact_->surfaces() && (untangle_->due() || contact_->forced() || drawn)) {
    untangle_->pull_apart();
    contact_->leave_out(untangle_->passing());
    contact_->restart();
  }
  if (!contact_->begun()) contact_->begin(threads);
}

// Ends the interval of `count` substeps before substep `end`.
void SheetContact::run_contact(const Substeps& frame, int end, int count, Threads& threads) {
  const auto start = std::chrono::steady_clock::now();
  if (TaskRecord* record = threads.record()) record->enter("self_collision");
  const double time = frame.time + end * frame.dt;
  until_ = contact_->run({frame.dt, count, length(gravity_at(scene_, time)), time}, threads);
  if (untangle_->due()) untangle_->calm(count * frame.dt);
  spent_ += std::chrono::steady_clock::now() - start;
  ++runs_;
  if (TaskRecord* record = threads.record()) record->enter("");
}

bool SheetContact::stands_by() const {
  return contact_->particles() >= kManyParticles;
}

}  // namespace weft::physics
