#include "renderer/scene/builtin/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/builtin/shapes.h"

// Throughout, phi is the angle around the body seen from above: 0 is the front (+Z), a quarter turn is the figure's
// left (+X). Heights y are metres above the ground, before the stance bends the spine.

namespace lightwell::builtin {
namespace {

/// A smooth curve through `knots` (x ascending): a cubic with the slopes of neighbouring chords, flat beyond the ends.
float curve(std::span<const glm::vec2> knots, float x) {
  if (x <= knots.front().x) return knots.front().y;
  if (x >= knots.back().x) return knots.back().y;
  std::size_t i = 0;
  while (knots[i + 1].x < x) ++i;
  const auto slope = [&](std::size_t k) {
    const glm::vec2 &before = knots[k > 0 ? k - 1 : k], &after = knots[std::min(k + 1, knots.size() - 1)];
    return (after.y - before.y) / (after.x - before.x);
  };
  const float span = knots[i + 1].x - knots[i].x, t = (x - knots[i].x) / span, t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * knots[i].y + (t3 - 2 * t2 + t) * span * slope(i) + (3 * t2 - 2 * t3) * knots[i + 1].y +
         (t3 - t2) * span * slope(i + 1);
}

float bell(float distance) {
  return std::exp(-distance * distance);
}

/// The difference of two angles in -pi..pi.
float turned(float phi, float from) {
  return std::remainder(phi - from, glm::two_pi<float>());
}

/// Contrapposto: what the stance does to a point of an upright body. The hips shift over the standing leg and rise
/// there, the shoulders answer by sinking on that side, and the trunk turns a little between them.
glm::vec3 stand(const glm::vec3& p) {
  constexpr glm::vec2 kShiftX[] = {{0.0f, 0.0f},   {0.5f, -0.03f},  {0.88f, -0.058f}, {1.06f, -0.034f},
                                   {1.3f, 0.012f}, {1.45f, 0.016f}, {1.6f, -0.002f},  {1.8f, -0.020f}};
  constexpr glm::vec2 kShiftZ[] = {{0.0f, 0.0f},    {0.6f, 0.016f},   {0.88f, 0.018f}, {1.06f, 0.002f},
                                   {1.3f, -0.022f}, {1.45f, -0.022f}, {1.6f, 0.012f},  {1.8f, 0.030f}};
  constexpr glm::vec2 kTilt[] = {{0.3f, 0.0f}, {0.88f, -0.15f}, {1.06f, -0.02f}, {1.42f, 0.16f}, {1.6f, 0.02f}};
  constexpr glm::vec2 kTurn[] = {{0.0f, 0.0f}, {0.88f, -0.14f}, {1.06f, 0.0f}, {1.4f, 0.14f}, {1.6f, 0.14f}};
  const float angle = curve(kTurn, p.y), c = std::cos(angle), s = std::sin(angle);
  return {c * p.x + s * p.z + curve(kShiftX, p.y), p.y + curve(kTilt, p.y) * p.x,
          c * p.z - s * p.x + curve(kShiftZ, p.y)};
}

/// A cross-section: an ellipse whose front and back halves differ, a little squared.
glm::vec2 section(float phi, float half_width, float front, float back, float power) {
  const auto squared = [=](float v) { return std::copysign(std::pow(std::abs(v), power), v); };
  const float z = squared(std::cos(phi));
  return {half_width * squared(std::sin(phi)), (z > 0.0f ? front : back) * z};
}

glm::vec3 torso_point(float phi, float y) {
  constexpr glm::vec2 kWidth[] = {{0.80f, 0.180f},  {0.90f, 0.182f},  {0.98f, 0.160f},  {1.07f, 0.127f},
                                  {1.15f, 0.132f},  {1.23f, 0.143f},  {1.31f, 0.152f},  {1.39f, 0.166f},
                                  {1.435f, 0.160f}, {1.468f, 0.112f}, {1.495f, 0.070f}, {1.53f, 0.052f},
                                  {1.63f, 0.048f}};
  constexpr glm::vec2 kFront[] = {{0.80f, 0.100f}, {0.92f, 0.112f}, {1.0f, 0.110f},  {1.07f, 0.098f},
                                  {1.16f, 0.102f}, {1.25f, 0.104f}, {1.33f, 0.102f}, {1.40f, 0.088f},
                                  {1.46f, 0.060f}, {1.50f, 0.046f}, {1.54f, 0.043f}, {1.63f, 0.040f}};
  constexpr glm::vec2 kBack[] = {{0.80f, 0.100f}, {0.88f, 0.116f}, {0.97f, 0.098f}, {1.06f, 0.078f},
                                 {1.16f, 0.088f}, {1.28f, 0.102f}, {1.38f, 0.100f}, {1.44f, 0.082f},
                                 {1.49f, 0.060f}, {1.54f, 0.050f}, {1.63f, 0.040f}};
  glm::vec2 xz = section(phi, curve(kWidth, y), curve(kFront, y), curve(kBack, y), 0.88f);
  float out = 0.0f;
  for (const float side : {-1.0f, 1.0f}) {
    const float across = turned(phi, side * 0.60f) / 0.38f, up = y - 1.280f;
    out += 0.060f * bell(across) * bell(up / (up > 0.0f ? 0.072f : 0.044f));  // breasts, fuller below
    out += 0.012f * bell(turned(phi, glm::pi<float>() + side * 0.55f) / 0.4f) * bell((y - 0.90f) / 0.06f);
    out += 0.010f * bell(turned(phi, glm::pi<float>() + side * 0.6f) / 0.35f) * bell((y - 1.36f) / 0.06f);
    out -= 0.007f * bell(turned(phi, side * 0.75f) / 0.25f) * bell((y - 0.95f) / 0.06f);  // the groin's line
  }
  const float front_line = bell(turned(phi, 0.0f) / 0.16f), back_line = bell(turned(phi, glm::pi<float>()) / 0.2f);
  out -= 0.008f * front_line * bell((y - 1.14f) / 0.11f);  // between the muscles of the belly
  out += 0.010f * bell(turned(phi, 0.0f) / 0.6f) * bell((y - 0.965f) / 0.06f);
  out -= 0.014f * back_line * bell((y - 1.18f) / 0.20f);  // along the spine
  xz += out * glm::normalize(xz);
  return stand({xz.x, y, xz.y});
}

MeshBuilder torso() {
  constexpr int kColumns = 24, kRows = 17;
  MeshBuilder mesh;
  mesh.grid(make_grid(kColumns, kRows, true, [](float u, float v) {
    // Columns lie closer at the front, where the forms are.
    const float phi = glm::two_pi<float>() * u - 0.35f * std::sin(glm::two_pi<float>() * u);
    return torso_point(phi, glm::mix(0.86f, 1.61f, v));
  }));
  return mesh;
}

/// A tapering limb along a bent path, its end cut flat.
MeshBuilder stump(std::span<const glm::vec3> path, std::span<const float> radii) {
  std::vector<glm::vec3> placed;
  for (const glm::vec3& p : path) placed.push_back(stand(p));
  return tube(placed, radii, 8);
}

float head_radius(float phi, float y) {
  // y from the chin (0) to the crown (1).
  const float around = std::abs(turned(phi, 0.0f));
  const float face = 1.0f - glm::smoothstep(0.9f, 1.5f, around);
  float out = 0.0f;
  out += 0.022f * bell(turned(phi, 0.0f) / 0.17f) * bell((y - 0.40f) / 0.085f);  // nose
  out += 0.012f * bell(turned(phi, 0.0f) / 0.13f) * bell((y - 0.50f) / 0.08f);
  out += 0.008f * bell(turned(phi, 0.0f) / 0.30f) * bell((y - 0.215f) / 0.05f);  // lips
  out += 0.007f * bell(turned(phi, 0.0f) / 0.35f) * bell((y - 0.05f) / 0.07f);   // chin
  for (const float side : {-1.0f, 1.0f}) {
    out -= 0.016f * bell(turned(phi, side * 0.36f) / 0.20f) * bell((y - 0.485f) / 0.055f);  // eyes
    out += 0.005f * bell(turned(phi, side * 0.36f) / 0.30f) * bell((y - 0.585f) / 0.04f);   // brows
    out += 0.004f * bell(turned(phi, side * 0.62f) / 0.25f) * bell((y - 0.36f) / 0.09f);    // cheeks
  }
  // Hair: above a line that falls from the forehead's middle to the nape, in waves parted at the middle.
  const float line = glm::mix(0.72f, 0.28f, glm::smoothstep(0.45f, 2.0f, around));
  const float hair = glm::smoothstep(line - 0.04f, line + 0.05f, y);
  out += hair * (0.016f + 0.004f * std::sin(14.0f * around + 9.0f * y)) - 0.012f * hair * bell(around / 0.12f) * face;
  return out;
}

MeshBuilder head() {
  // Columns in degrees, closest around the nose.
  constexpr std::array kColumns = {0.0f,   9.0f,   20.0f,  36.0f,  57.0f,  84.0f,  115.0f, 148.0f,
                                   180.0f, 212.0f, 245.0f, 276.0f, 303.0f, 324.0f, 340.0f, 351.0f};
  constexpr std::array kRows = {0.0f, 0.06f, 0.15f, 0.22f, 0.31f, 0.39f, 0.48f, 0.585f, 0.71f, 0.88f, 1.0f};
  constexpr glm::vec2 kWidth[] = {{0.0f, 0.0f},   {0.05f, 0.036f}, {0.14f, 0.052f}, {0.3f, 0.064f}, {0.5f, 0.070f},
                                  {0.7f, 0.073f}, {0.85f, 0.062f}, {0.95f, 0.038f}, {1.0f, 0.0f}};
  constexpr glm::vec2 kFront[] = {{0.0f, 0.0f},   {0.05f, 0.066f}, {0.14f, 0.076f}, {0.3f, 0.081f}, {0.5f, 0.084f},
                                  {0.7f, 0.082f}, {0.85f, 0.066f}, {0.95f, 0.038f}, {1.0f, 0.0f}};
  constexpr glm::vec2 kBack[] = {{0.0f, 0.0f},   {0.05f, 0.030f}, {0.14f, 0.050f}, {0.3f, 0.072f}, {0.5f, 0.092f},
                                 {0.7f, 0.094f}, {0.85f, 0.076f}, {0.95f, 0.044f}, {1.0f, 0.0f}};
  constexpr float kChin = 1.552f, kCrown = 1.782f;
  Grid grid{static_cast<int>(kColumns.size()), static_cast<int>(kRows.size()), true, {}};
  for (const float y : kRows)
    for (const float degrees : kColumns) {
      const float phi = glm::radians(degrees);
      glm::vec2 xz = section(phi, curve(kWidth, y), curve(kFront, y), curve(kBack, y), 0.94f);
      if (y > 0.0f && y < 1.0f) xz += head_radius(phi, y) * glm::normalize(xz);
      grid.points.emplace_back(xz.x, glm::mix(kChin, kCrown, y), xz.y);
    }
  MeshBuilder mesh, placed;
  mesh.grid(grid);
  mesh.append(sphere(0.048f, 7, 4), glm::translate(glm::mat4(1.0f), {0.0f, 1.685f, -0.118f}));  // the knot of hair
  // She looks to her left and a little down.
  const glm::vec3 pivot(0.0f, 1.60f, -0.01f);
  glm::mat4 turn = glm::translate(glm::mat4(1.0f), stand(pivot));
  turn = glm::rotate(turn, 0.34f, {0, 1, 0});
  turn = glm::rotate(turn, 0.07f, {1, 0, 0});
  turn = glm::rotate(turn, -0.05f, {0, 0, 1});
  placed.append(mesh, glm::translate(turn, -pivot));
  return placed;
}

constexpr int kFolds = 11;          // around the drapery,
constexpr int kColumnsPerFold = 4;  // each a ridge, a slope, a valley and a slope

/// The line of the rolled edge around the hips.
float drapery_top(float phi) {
  return 0.91f + 0.045f * std::sin(phi) - 0.02f * std::cos(phi);
}

/// How far out the folds lift the cloth. Columns of the grid run along ridges and valleys, so that few triangles draw
/// them sharply. They hang from the hips, are taut over the bent thigh and knee, and deepen towards the hem.
float fold_depth(int column, float h, float taut) {
  constexpr std::array kProfile = {1.0f, 0.15f, -1.0f, 0.15f};
  const int fold = column / kColumnsPerFold;
  const float size = 0.75f + 0.45f * std::sin(2.4f * static_cast<float>(fold) + 0.7f);  // no two alike
  const float start = 0.78f + 0.18f * std::sin(1.7f * static_cast<float>(fold) + 2.0f);
  const float depth = 0.014f + 0.042f * glm::smoothstep(1.0f - start, 1.0f, 1.0f - h);
  return depth * size * (1.0f - taut) * kProfile[static_cast<std::size_t>(column % kColumnsPerFold)];
}

/// The cloth's middle without folds: `h` is 0 at the hem and 1 at the hips.
glm::vec2 drapery_section(float phi, float h) {
  constexpr glm::vec2 kWidth[] = {{0.0f, 0.205f},  {0.05f, 0.192f}, {0.25f, 0.160f}, {0.5f, 0.174f},
                                  {0.75f, 0.198f}, {0.9f, 0.199f},  {1.0f, 0.190f}};
  constexpr glm::vec2 kDepth[] = {{0.0f, 0.180f},  {0.05f, 0.166f}, {0.25f, 0.125f}, {0.5f, 0.128f},
                                  {0.75f, 0.138f}, {0.9f, 0.138f},  {1.0f, 0.130f}};
  return section(phi, curve(kWidth, h), curve(kDepth, h), curve(kDepth, h), 0.92f);
}

glm::vec3 drapery_point(int column, float h) {
  const float fall = 1.0f - h;
  float phi = glm::two_pi<float>() * static_cast<float>(column) / (kFolds * kColumnsPerFold);
  // From the hips the folds are drawn over to the bent knee, below it they fall straight.
  phi += 0.38f * std::sin(glm::pi<float>() * std::min(1.4f * fall, 1.0f)) * std::cos(0.5f * turned(phi, 0.1f)) - 0.12f;
  glm::vec2 xz = drapery_section(phi, h);

  // The bent leg: thigh, knee and shin push the cloth forward on her left; the standing leg shows faintly.
  constexpr glm::vec2 kBent[] = {{0.0f, 0.03f},   {0.15f, 0.030f}, {0.40f, 0.070f}, {0.55f, 0.118f},
                                 {0.66f, 0.098f}, {0.85f, 0.035f}, {1.0f, 0.0f}};
  const float bent = bell(turned(phi, 0.58f) / 0.44f), standing = bell(turned(phi, -0.62f) / 0.45f);
  float out = curve(kBent, h) * bent + 0.026f * standing * bell((h - 0.6f) / 0.35f);
  out -= 0.036f * bell(turned(phi, -0.08f) / 0.30f) * bell((h - 0.36f) / 0.28f);  // the hollow between the legs
  const float between = 0.45f * bell(turned(phi, 0.05f) / 0.35f);                 // is fold enough
  const float taut = 0.9f * bent * bell((h - 0.64f) / 0.26f) + 0.5f * standing * bell((h - 0.75f) / 0.25f);
  out += fold_depth(column, h, std::min(taut + between, 1.0f));
  xz += out * glm::normalize(xz);
  return stand({xz.x, drapery_top(phi) * h, xz.y});
}

/// The upper edge, rolled and twisted into a thick cord. Its seam lies inside the body.
MeshBuilder drapery_roll() {
  MeshBuilder mesh;
  mesh.grid(make_grid(22, 5, true, [](float u, float v) {
    const float phi = glm::two_pi<float>() * u, around = glm::two_pi<float>() * v;  // inside, below, outside, above
    const float thick = 0.034f * (1.0f + 0.28f * std::sin(5.0f * phi + 2.0f * around) + 0.25f * std::sin(phi + 0.4f));
    glm::vec2 xz = drapery_section(phi, 1.0f);
    xz += (0.004f - thick * std::cos(around)) * glm::normalize(xz);
    return stand({xz.x, drapery_top(phi) - 1.15f * thick * std::sin(around), xz.y});
  }));
  return mesh;
}

}  // namespace

MeshBuilder figure_body() {
  MeshBuilder mesh = torso();
  mesh.append(head());
  const std::array right = {glm::vec3(-0.080f, 1.408f, -0.008f), glm::vec3(-0.145f, 1.398f, -0.010f),
                            glm::vec3(-0.188f, 1.350f, -0.012f), glm::vec3(-0.200f, 1.27f, -0.016f),
                            glm::vec3(-0.200f, 1.17f, -0.010f)};
  mesh.append(stump(right, std::array{0.046f, 0.060f, 0.056f, 0.048f, 0.042f}));
  const std::array left = {glm::vec3(0.085f, 1.412f, -0.008f), glm::vec3(0.150f, 1.400f, -0.006f),
                           glm::vec3(0.200f, 1.378f, 0.006f), glm::vec3(0.243f, 1.352f, 0.026f)};
  mesh.append(stump(left, std::array{0.046f, 0.060f, 0.054f, 0.047f}));
  return mesh;
}

MeshBuilder figure_drapery() {
  // Rows, as fractions of the way up, crowd at the hem.
  constexpr std::array kRows = {0.0f, 0.06f, 0.16f, 0.26f, 0.36f, 0.46f, 0.55f, 0.64f, 0.75f, 0.88f, 1.0f};
  Grid grid{kFolds * kColumnsPerFold, static_cast<int>(kRows.size()), true, {}};
  for (const float h : kRows)
    for (int column = 0; column < grid.columns; ++column) grid.points.push_back(drapery_point(column, h));
  MeshBuilder mesh;
  mesh.grid(grid);
  mesh.append(drapery_roll());
  return mesh;
}

}  // namespace lightwell::builtin
