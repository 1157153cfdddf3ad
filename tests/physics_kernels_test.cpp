// Every kernel gives the same bits for every instruction set that this machine runs, whatever the
// width of a row and the features in use. The padding behind a row holds other values each time, so
// that a lane that leaks in from there shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "kernel_patch.h"
#include "physics/contact/colliders/shapes.h"
#include "physics/kernels/kernels.h"
#include "physics/kernels/lattice.h"

namespace weft::physics {
namespace {

using Call = std::function<void(const KernelTable&, Patch&)>;
struct Case {
  std::string name;
  int least_columns;
  Call call;
};

AdvanceRow advance_row(Patch& p) {
  return {p.columns, p.x.row(0), p.v.row(0), p.weights(0), p.f.row(0), advance(), 100.0f};
}

StencilRow stencil_row(Patch& p, int di, int dj) {
  StencilRow r{};
  r.count = p.columns - std::abs(di);
  r.near = std::max(0, -di);
  r.far = std::max(0, di);
  r.same_row = dj == 0;
  const int other = std::min(dj, kRows - 1);
  r.x = p.x.row(0);
  r.x_far = p.x.row(other);
  r.v = p.v.row(0);
  r.v_far = p.v.row(other);
  r.w = p.weights(0);
  r.w_far = p.weights(other);
  r.f = p.f.row(0);
  r.f_far = p.f.row(other);
  r.scratch = p.scratch.data() + kGuard;
  r.stride = p.stride;
  r.spring = {70, 63, 0.4f};
  return r;
}

constexpr std::array<std::array<int, 2>, 12> kOffsets{{{1, 0},
                                                       {2, 0},
                                                       {3, 0},
                                                       {5, 0},
                                                       {16, 0},
                                                       {0, 1},
                                                       {1, 1},
                                                       {-1, 1},
                                                       {2, 2},
                                                       {-2, 2},
                                                       {7, 1},
                                                       {-16, 1}}};

// A Jacobi sweep over rows begin … end-1, rigid or compliant.
void jacobi_rows(const KernelTable& k, Patch& p, float compliance, bool alike, bool sides,
                 bool torn, int begin, int end) {
  if (alike) p.weigh_alike();
  if (sides) p.halve_sides();
  std::vector<JacobiConstants> constraints;
  JacobiRows r{};
  for (int j = 0; j < kRows; ++j)
    for (int f = 0; f < kPlainStencils; ++f) {
      r.rest[f] = 0.9f + 0.1f * float(f);
      const int dj = f == 5 ? 2 : f == 0 || f == 4 ? 0 : 1;
      const float kappa = 1 / (2 * 0.8f * 3 + compliance);
      if (j + dj < kRows)
        constraints.push_back({compliance, kappa, kappa * r.rest[f],
                               sides && f != 1 && f != 5 ? 0.7f : 1,
                               sides && f != 1 && f != 5 ? 0.5f : 1});
      else
        constraints.push_back({std::numeric_limits<float>::infinity(), 0, 0});
    }
  fill(r, p, begin, end, torn);
  r.alike = alike ? 0.8f : 0;
  r.constants = constraints.data();
  r.weight = 3;
  r.inverse_dt = compliance > 0 ? 100.0f : 0.0f;
  call_carrying(k, &LatticeKernels::jacobi_rows, r, p);
}

// A kernel over all rows at once, and in two parts.
void add_rows(std::vector<Case>& cases, const std::string& name,
              const std::function<void(const KernelTable&, Patch&, int begin, int end)>& run) {
  cases.push_back({name, 2, [=](const KernelTable& k, Patch& p) { run(k, p, 0, kRows); }});
  cases.push_back({name + ", in two parts", 2, [=](const KernelTable& k, Patch& p) {
                     run(k, p, 0, 1);
                     run(k, p, 1, kRows);
                   }});
}

void add_jacobi(std::vector<Case>& cases) {
  for (const float compliance : {0.0f, 0.7f})
    for (const bool alike : {false, true})
      for (const bool sides : {false, true})
        for (const bool torn : {false, true})
          add_rows(cases,
                   std::string("jacobi_rows, ") + (compliance > 0 ? "compliant" : "rigid") +
                       (alike ? ", alike" : "") + (sides ? ", sides" : "") + (torn ? ", torn" : ""),
                   [=](const KernelTable& k, Patch& p, int begin, int end) {
                     jacobi_rows(k, p, compliance, alike, sides, torn, begin, end);
                   });
}

void add_springs(std::vector<Case>& cases) {
  for (const bool damped : {false, true})
    for (const bool torn : {false, true})
      for (const bool sides : {false, true})
        add_rows(cases,
                 std::string("spring_rows") + (damped ? ", damped" : "") + (torn ? ", torn" : "") +
                     (sides ? ", sides" : ""),
                 [=](const KernelTable& k, Patch& p, int begin, int end) {
                   if (sides) p.halve_sides();
                   spring_rows(k, p, damped, torn, begin, end);
                 });
  for (const bool damped : {false, true})
    add_rows(cases, std::string("spring_rows, watched") + (damped ? ", damped" : ""),
             [=](const KernelTable& k, Patch& p, int begin, int end) {
               std::uint8_t overlong[kRows] = {};
               spring_rows(k, p, damped, true, begin, end, 2, overlong);
               for (int j = begin; j < end; ++j) p.lambda[j % p.columns] += overlong[j];
             });
  for (const bool alike : {false, true})
    add_rows(cases, std::string("spring_rows, finely") + (alike ? ", alike" : ""),
             [=](const KernelTable& k, Patch& p, int begin, int end) {
               if (alike) p.weigh_alike();
               spring_rows(k, p, false, false, begin, end, 0, nullptr, alike ? 0.8f : 0,
                           {p.previous.row(0), p.f.row(0)});
             });
  for (const auto& [di, dj] : kOffsets) {
    const std::string at = " (" + std::to_string(di) + "," + std::to_string(dj) + ")";
    const auto springs = [di = di, dj = dj](auto kernel) {
      return [=](const KernelTable& k, Patch& p) { (k.lattice.*kernel)(stencil_row(p, di, dj)); };
    };
    const int least = std::abs(di) + 1;
    cases.push_back({"spring_stencil" + at, least, springs(&LatticeKernels::spring_stencil)});
    cases.push_back(
        {"damped_spring_stencil" + at, least, springs(&LatticeKernels::damped_spring_stencil)});
  }
}

void add_moves(std::vector<Case>& cases) {
  const auto move = [](auto kernel, bool finely = false) {
    return [=](const KernelTable& k, Patch& p) {
      AdvanceRow r = advance_row(p);
      if (finely) r.left = {p.previous.row(0), p.carry.row(0)};
      (k.particles.*kernel)(r);
    };
  };
  cases.push_back({"integrate", 2, move(&ParticleKernels::integrate)});
  cases.push_back({"predict", 2, [](const KernelTable& k, Patch& p) {
                     AdvanceRow r = advance_row(p);
                     r.f = {};
                     k.particles.predict(r);
                   }});
  cases.push_back({"predict, corrections first", 2, move(&ParticleKernels::predict)});
  cases.push_back({"apply_corrections", 2, move(&ParticleKernels::apply_corrections)});
  cases.push_back({"integrate, finely", 2, move(&ParticleKernels::integrate, true)});
  cases.push_back({"predict, finely", 2, move(&ParticleKernels::predict, true)});
  cases.push_back(
      {"apply_corrections, finely", 2, move(&ParticleKernels::apply_corrections, true)});
}

struct Features {
  const char* name;
  float compliance, weight;
  bool limit, multipliers, alike = false, sides = false, tears = false;
};
constexpr Features kFeatures[] = {{"rigid", 0, 1, false, false},
                                  {"heavier", 0, 1.7f, false, false},
                                  {"compliant", 0.7f, 1, false, false},
                                  {"multipliers", 0.7f, 1, false, true},
                                  {"limit", 0, 1, true, false},
                                  {"rigid, alike", 0, 1, false, false, true},
                                  {"compliant, alike", 0.7f, 1, false, false, true},
                                  {"multipliers, alike", 0.7f, 1, false, true, true},
                                  {"compliant, sides", 0.7f, 1, false, false, false, true},
                                  {"rigid, alike, sides", 0, 1, false, false, true, true},
                                  {"compliant, alike, sides", 0.7f, 1, false, false, true, true},
                                  {"multipliers, alike, sides", 0.7f, 1, false, true, true, true},
                                  {"rigid, tears", 0, 1.7f, false, false, false, false, true},
                                  {"multipliers, tears", 0.7f, 1, false, true, false, false, true}};

void project_offset(const KernelTable& k, Patch& p, int di, int dj, const Features& has,
                    bool jacobi) {
  ProjectRows r{};
  r.rows = kRows;
  r.stride = p.stride;
  r.x = p.x.row(0);
  r.v = p.v.row(0);
  r.w = p.weights(0);
  r.count = p.columns - std::abs(di);
  r.near = std::max(0, -di);
  r.far = std::max(0, di);
  r.dj = dj;
  r.rest = has.limit ? 1.1f : 0.9f;
  r.weight = has.weight;
  std::array<float, kRows> compliance;
  compliance.fill(has.compliance);
  if (has.compliance > 0) r.compliance = compliance.data();
  if (has.multipliers) r.lambda = p.lambda.data();
  r.limit = has.limit ? physics::LimitSweep::once : physics::LimitSweep::none;
  if (has.limit) r.inverse_dt = 100;
  // Gauss–Seidel gathers what constraints find.
  if (!has.limit && !jacobi) r.u = p.previous.row(0);
  if (has.alike) {
    p.weigh_alike();
    r.row_w = p.row_w.data();
  }
  if (has.sides) {
    p.halve_sides();
    r.side_by_side = di != 0;
    if (di == 0) r.inverse_width = p.inverse_width.data();
  }
  std::array<std::int32_t, kRows> ended{};
  if (has.tears) {
    r.alive = p.alive.data();
    r.longest_square = 1.44f;
    r.ended = ended.data();
  }
  for (int a = 0; dj == 0 && a < r.count; ++a) p.lanes[std::size_t(a / di % 2 * p.stride + a)] = -1;
  r.lanes = p.lanes.data();
  if (jacobi) return k.lattice.jacobi_stencil(r, 0, p.f.row(0), p.f.row(dj));
  // Along rows all of them: two may be worked through together.
  k.lattice.project({&r, 1, 0, dj == 0 ? kRows : 1, 0});
  // What has ended is to be compared as well.
  for (int j = 0; j < kRows; ++j) p.f.at(0, j, 0) += float(ended[std::size_t(j)]);
  for (int a = 0; has.tears && a < r.count; ++a) p.f.at(1, 0, a) += float(p.alive[std::size_t(a)]);
}

void add_projections(std::vector<Case>& cases) {
  for (const auto& [di, dj] : kOffsets)
    for (const Features& has : kFeatures)
      for (const bool jacobi : {false, true})
        if (!(jacobi && (has.limit || has.alike)))
          cases.push_back({(jacobi ? "project_jacobi (" : "project (") + std::to_string(di) + "," +
                               std::to_string(dj) + ") " + has.name,
                           std::abs(di) + 1,
                           [di = di, dj = dj, &has, jacobi](const KernelTable& k, Patch& p) {
                             project_offset(k, p, di, dj, has, jacobi);
                           }});
}

// In the order of weft::Shape.

// A ball's surface as it is found for a row: distances and normals where its particles are, and where they
// come from.
class FoundBall {
 public:
  FoundBall(const CollideRow& r, float radius) {
    for (auto& list : lists_) list.assign(std::size_t(r.columns) + 16, 1);
    for (int i = 0; i < r.columns; ++i)
      for (int before = 0; before < 2; ++before) {
        const float back = float(before) * r.dt;
        const float way[3] = {r.x.x[i] - back * r.v.x[i] - r.cx, r.x.y[i] - back * r.v.y[i] - r.cy,
                              r.x.z[i] - back * r.v.z[i] - r.cz};
        const float length = std::sqrt(1e-6f + way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
        at(before, 0, i) = length - radius;
        for (int k = 0; k < 3; ++k) at(before, 1 + k, i) = way[k] / length;
      }
  }
  FoundSurface surface() { return {&at(0, 0, 0), normal(0), &at(1, 0, 0), normal(1)}; }

 private:
  float& at(int before, int part, int i) {
    return lists_[std::size_t(4 * before + part)][std::size_t(i)];
  }
  ConstRow3 normal(int before) { return {&at(before, 1, 0), &at(before, 2, 0), &at(before, 3, 0)}; }
  std::array<std::vector<float>, 8> lists_;
};

// Of a shape about as large, askew; of a mesh there are none.
template <class Shape>
ShapeConstants constants_askew(float size) {
  if constexpr (requires { Shape::of_size(1.0); }) {
    Shape shape = Shape::of_size(2 * double(size));
    Shape::values(shape, [&](const char*, auto& value, ShapeValue is) {
      if constexpr (std::is_same_v<decltype(value), Vec3&>) {
        if (is == ShapeValue::point) value = {0.3 * value[1], 0.8 * value[1], 0.5 * value[1]};
        if (is == ShapeValue::direction) value = {0.36, 0.8, 0.48};
        if (is == ShapeValue::angles) value = {20, 30, 40};
      }
    });
    return constants_of(shape);
  } else {
    return {};
  }
}
#define WEFT_CONSTANTS(Type, name) constants_askew<Type>,
constexpr ShapeConstants (*kConstants[])(float) = {WEFT_SHAPES(WEFT_CONSTANTS)};
#undef WEFT_CONSTANTS

void add_contacts(std::vector<Case>& cases) {
  // Model kFrictionModels: the layer in which sliding is damped.
  const auto touch = [](int shape, int model, float friction, bool moving) {
    return [=](const KernelTable& k, Patch& p) {
      CollideRow r{};
      r.columns = p.columns;
      r.x = p.x.row(0);
      r.v = p.v.row(0);
      r.w = p.weights(0);
      r.dt = 0.01f;
      r.inverse_dt = 100;
      // As wide as half the row, with a particle at its very centre.
      const int middle = p.columns / 2;
      r.cx = p.x.at(0, 0, middle);
      r.cy = p.x.at(1, 0, middle);
      r.cz = p.x.at(2, 0, middle);
      const float size = 1 + float(p.columns) / 4;
      FoundBall ball(r, size);
      const FoundSurface found = ball.surface();
      r.shape = kConstants[shape](size);
      r.shape.found = &found;  // of a mesh
      r.offset = 0.01f;
      if (moving) r.ux = 0.3f, r.uy = -0.2f, r.uz = 0.1f;
      r.friction_static = friction;
      r.friction_dynamic = 0.8f * friction;
      r.bias = 0.5f * size;
      r.damped = 0.3f;
      if (model == kFrictionModels)
        k.colliders[shape]->damp_sliding(r);
      else
        k.colliders[shape]->collide[model](r);
    };
  };
  for (const float friction : {0.0f, 0.4f})
    for (const bool moving : {false, true}) {
      const std::string has =
          std::string(friction > 0 ? " rough" : " smooth") + (moving ? ", moving" : "");
      for (int shape = 0; shape < kShapes; ++shape)
        for (int model = 0; model <= kFrictionModels; ++model)
          cases.push_back(
              {std::string(kShapeNames[shape]) + ", rule " + std::to_string(model) + has, 2,
               touch(shape, model, friction, moving)});
    }
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  add_springs(cases);
  add_jacobi(cases);
  add_moves(cases);
  add_projections(cases);
  add_contacts(cases);
  return cases;
}

std::vector<std::uint32_t> bits_after(const Case& test, Simd simd, int columns, float padding,
                                      bool& numbers) {
  Patch patch(columns, padding);
  test.call(kernel_table(simd), patch);
  numbers = true;
  return patch.bits(numbers);
}

class WideKernels : public testing::TestWithParam<Simd> {};

TEST_P(WideKernels, EqualTheScalarOnesBitForBit) {
  if (!simd_available(GetParam())) GTEST_SKIP() << "not on this machine";
  std::vector<int> widths{100, 316};
  for (int columns = 2; columns <= 70; ++columns) widths.push_back(columns);
  for (const Case& test : all_cases())
    for (const int columns : widths) {
      if (columns < test.least_columns) continue;
      bool numbers = false, scalar_numbers = false;
      const auto wide = bits_after(test, GetParam(), columns, 7.5f, numbers);
      const auto scalar = bits_after(test, Simd::scalar, columns, -0.3f, scalar_numbers);
      ASSERT_TRUE(numbers && scalar_numbers) << test.name << ", " << columns << " columns";
      ASSERT_EQ(wide, scalar) << test.name << ", " << columns << " columns";
    }
}

INSTANTIATE_TEST_SUITE_P(, WideKernels, testing::Values(Simd::sse2, Simd::avx2, Simd::avx512),
                         [](const auto& test) { return simd_name(test.param); });

// The bits above compare nothing if a kernel does nothing.
TEST(Kernels, EachChangesSomething) {
  for (const Case& test : all_cases()) {
    bool numbers = true;
    EXPECT_NE(bits_after(test, Simd::scalar, 40, 0, numbers), Patch(40, 0).bits(numbers))
        << test.name;
  }
}

}  // namespace
}  // namespace weft::physics
