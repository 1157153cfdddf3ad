#include "walk.h"

#include <numbers>
#include <stdexcept>

namespace mannequin {
namespace {

constexpr double kStarts = 0.7, kWalks = 1.7;  // s; the first step, and full speed
constexpr double kSpeed = 0.88;                // m/s
constexpr double kCycle = 1.12;                // s, two steps
constexpr double kStance = 0.62;               // of a cycle: how long a foot is on the ground
constexpr double kAhead = 1.3, kRadius = 1.1;  // m: straight on, then in a circle
constexpr double kApart = 0.085;               // m, of a foot from the line that is walked
constexpr double kTurn = 2 * std::numbers::pi;

double degrees(double d) {
  return d * std::numbers::pi / 180;
}

// Where the body is along its way [m].
double way_at(double time) {
  const double t = std::clamp((time - kStarts) / (kWalks - kStarts), 0.0, 1.0);
  const double ramp = t * t * t * (1 - t / 2);  // the integral of smooth()
  return kSpeed * ((kWalks - kStarts) * ramp + std::max(0.0, time - kWalks));
}

double heading_at(double way) {
  constexpr double kEase = 0.6;  // m, until it turns as it will
  const double past = std::max(0.0, way - kAhead);
  return past < kEase ? past * past / (2 * kEase * kRadius) : (past - kEase / 2) / kRadius;
}

Vec place_at(double way) {
  Vec p;
  constexpr int kPieces = 200;
  for (int n = 0; n < kPieces; ++n) {
    const double a = heading_at(way * (n + 0.5) / kPieces);
    p = p + Vec{std::sin(a), 0, std::cos(a)} * (way / kPieces);
  }
  return p;
}

// How much of a walk there is: 0 at rest.
double strength(double time) {
  return smooth(kStarts - 0.2, kWalks, time);
}

struct Foot {
  Vec ankle;
  double heading = 0, pitch = 0;  // rad; pitch > 0: toes up
};

// A foot stands from `begin` to begin + kStance kCycle, where the body is above it in the middle of that.
Foot planted(const Joints& j, int side, double begin) {
  const double way = way_at(begin + kStance * kCycle / 2), heading = heading_at(way);
  const double apart = begin + kStance * kCycle < kStarts + 0.3 ? j.ankle.x : kApart;
  const Vec out{std::cos(heading), 0, -std::sin(heading)};
  const Vec ahead{std::sin(heading), 0, std::cos(heading)};
  return {place_at(way) + out * (side * apart) + ahead * j.ankle.z + Vec{0, j.ankle.y, 0}, heading,
          0};
}

Foot foot_at(const Joints& j, int side, double time) {
  // The left foot leaves the ground first.
  const double first = kStarts + (side > 0 ? 0 : kCycle / 2) - kStance * kCycle;
  const double cycles = std::floor((time - first) / kCycle),
               begin = first + kCycle * std::max(0.0, cycles);
  const double phase = std::max(0.0, (time - begin) / kCycle), power = strength(time);
  Foot foot = planted(j, side, begin);
  const auto roll = [&](double pitch, Vec about) {
    const Rotation turn = about_y(foot.heading) * about_x(-pitch);
    foot.ankle = foot.ankle + about_y(foot.heading) * about + turn * (about * -1.0);
    foot.pitch = pitch;
  };
  const Vec ball = j.ball - j.ankle, heel = j.heel - j.ankle;
  const double up = degrees(16), down = degrees(-38);
  if (phase < kStance) {
    if (cycles >= 1 && phase < 0.1)
      roll(power * up * (1 - smooth(0, 0.1, phase)), {0, heel.y, heel.z});
    else
      roll(power * down * smooth(0.62 * kStance, kStance, phase), {0, ball.y, ball.z});
    return foot;
  }
  const double s = (phase - kStance) / (1 - kStance), go = smooth(0, 1, s);
  Foot next = planted(j, side, begin + kCycle);
  roll(power * down, {0, ball.y, ball.z});
  const Foot left = foot;
  foot = next;
  roll(power * up, {0, heel.y, heel.z});
  foot.ankle =
      mixed(left.ankle, foot.ankle, go) + Vec{0, power * 0.055 * std::sin(std::numbers::pi * s), 0};
  foot.heading = left.heading + (next.heading - left.heading) * go;
  foot.pitch = left.pitch + (power * up - left.pitch) * smooth(0, 0.9, s);
  return foot;
}

class Poser {
 public:
  Poser(const Joints& joints, double time) : j_(joints), time_(time) {
    phase_ = kTurn * (time - kStarts) / kCycle;
    power_ = strength(time);
    trunk();
    for (const int side : {-1, 1}) {
      leg(side);
      arm(side);
    }
  }
  Body take() { return std::move(body_); }

 private:
  static Vec of_side(Vec p, int side) { return side > 0 ? p : mirrored(p); }
  void put(Bone bone, int side, const Rotation& turn, Vec from, Vec at) {
    body_.bones.push_back({{bone, side}, {turn, from, at}});
  }
  const Pose& of(Bone bone, int side = 0) const { return body_.of({bone, side}); }

  // The hips turn with the leg ahead and drop on the side of the one that swings; the chest turns against them.
  void trunk() {
    const double way = way_at(time_), heading = heading_at(way);
    const Rotation along = about_y(heading);
    // At kCycle kStance / 2 before a foot leaves, the body is above it.
    const double swing = std::sin(phase_ - 0.1 * kTurn),
                 double_time = std::cos(2 * (phase_ + 0.31 * kTurn));
    const Rotation hips = along * about_y(power_ * degrees(-6) * swing) *
                          about_z(power_ * degrees(3.5) * std::cos(phase_ - 0.19 * kTurn));
    const Vec side = along * Vec{power_ * -0.018 * std::cos(phase_ - 0.19 * kTurn), 0, 0};
    const Vec at =
        place_at(way) + side + j_.pelvis +
        Vec{0, -0.004 * smooth(0, kStarts, time_) - power_ * (0.019 - 0.015 * double_time), 0};
    put(Bone::pelvis, 0, hips, j_.pelvis, at);
    const Rotation lean = about_x(power_ * degrees(3));
    const Rotation waist = along * about_y(power_ * degrees(-1) * swing) * lean;
    put(Bone::waist, 0, waist, j_.waist, of(Bone::pelvis)(j_.waist));
    const Rotation chest = along * about_y(power_ * degrees(6) * swing) * lean *
                           about_z(power_ * degrees(-1.5) * std::cos(phase_ - 0.19 * kTurn));
    put(Bone::chest, 0, chest, j_.chest, of(Bone::waist)(j_.chest));
    put(Bone::neck, 0, along * about_y(power_ * degrees(2) * swing), j_.neck,
        of(Bone::chest)(j_.neck));
    put(Bone::head, 0, along * about_x(power_ * degrees(1)), j_.head, of(Bone::neck)(j_.head));
  }

  void leg(int side) {
    const Foot foot = foot_at(j_, side, time_);
    const Vec hip = of_side(j_.hip, side), knee = of_side(j_.knee, side),
              ankle = of_side(j_.ankle, side);
    const Vec from = of(Bone::pelvis)(hip), way = foot.ankle - from;
    const double thigh = length(knee - hip), shin = length(ankle - knee);
    const double reach = std::min(length(way), 0.9995 * (thigh + shin));
    const double bend = (thigh * thigh + reach * reach - shin * shin) / (2 * thigh * reach);
    const double angle = std::acos(std::clamp(bend, -1.0, 1.0));
    const Vec ahead =
        about_y((heading_at(way_at(time_)) + foot.heading) / 2 + side * degrees(4)) * Vec{0, 0, 1};
    const Rotation frame = along(way, ahead);
    const Vec bent = from + (frame.b * std::cos(angle) + frame.c * std::sin(angle)) * thigh;
    const Rotation thigh_turn =
        along(bent - from, ahead) * transposed(along(knee - hip, {0, 0, 1}));
    const Rotation shin_turn =
        along(foot.ankle - bent, ahead) * transposed(along(ankle - knee, {0, 0, 1}));
    put(Bone::thigh, side, thigh_turn, hip, from);
    put(Bone::shin, side, shin_turn, knee, bent);
    const Vec reached = bent + unit(foot.ankle - bent) * shin;
    put(Bone::foot, side, about_y(foot.heading) * about_x(-foot.pitch), ankle, reached);
  }

  void arm(int side) {
    const Vec shoulder = of_side(j_.shoulder, side), elbow = of_side(j_.elbow, side),
              wrist = of_side(j_.wrist, side);
    const double rest = std::atan2(j_.elbow.x - j_.shoulder.x, j_.shoulder.y - j_.elbow.y);
    const double lowered = smooth(0.1, 1.5, time_);
    const double swing =
        side * power_ * degrees(20) * std::sin(phase_ - 0.1 * kTurn) - power_ * degrees(4);
    const double out = rest + lowered * (degrees(19) - rest);
    const Rotation chest = of(Bone::chest).turn;
    const Rotation upper = chest * about_x(-swing) * about_z(side * (out - rest));
    put(Bone::upper_arm, side, upper, shoulder, of(Bone::chest)(shoulder));
    const double flex = lowered * degrees(14) + power_ * degrees(10) + std::max(0.0, swing) * 0.7;
    const Rotation fore = upper * along(elbow - shoulder, {0, 0, 1}) * about_x(flex) *
                          transposed(along(elbow - shoulder, {0, 0, 1}));
    put(Bone::forearm, side, fore, elbow, of(Bone::upper_arm, side)(elbow));
    put(Bone::hand, side, fore, wrist, of(Bone::forearm, side)(wrist));
  }

  const Joints& j_;
  double time_, phase_ = 0, power_ = 0;
  Body body_;
};

}  // namespace

const Pose& Body::of(BoneOf bone) const {
  for (const auto& [name, pose] : bones)
    if (name == bone) return pose;
  throw std::logic_error("the bone is not placed yet");
}

Body pose_at(const Joints& joints, double time) {
  return Poser(joints, time).take();
}

}  // namespace mannequin
