#include "tests/gl/trace_scenes.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace lightwell::test {
namespace {

constexpr float kFar = 1e30f;

// Portable where std::uniform_real_distribution is not: the same numbers with every standard library.
float uniform(std::mt19937& random) {
  return static_cast<float>(random() >> 8) * 0x1p-24f;
}
glm::vec3 uniform_3(std::mt19937& random) {
  const float x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

glm::vec3 on_sphere(std::mt19937& random) {
  const float z = 1.0f - 2.0f * uniform(random);
  const float angle = glm::two_pi<float>() * uniform(random);
  const float radius = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

// A grid of side x side cells, the vertex of (s, t) in [0, 1]^2 placed by `place`.
template <class Place>
std::shared_ptr<Primitive> grid(std::uint32_t side, Place place) {
  auto primitive = std::make_shared<Primitive>();
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x) {
      const glm::vec2 st = glm::vec2(x, y) / static_cast<float>(side);
      primitive->positions.push_back(place(st));
      primitive->uv0.push_back(st);
    }
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
      primitive->indices.insert(primitive->indices.end(), {a, b, c, b, d, c});
    }
  fill_bounds(*primitive);
  return primitive;
}

}  // namespace

void TraceWorld::add(std::shared_ptr<const Primitive> primitive, const glm::mat4& world_from_object, Coverage covered) {
  Instance instance;
  instance.primitive = std::move(primitive);
  instance.world_from_object = world_from_object;
  instance.node = static_cast<int>(instances.size());
  instances.push_back(std::move(instance));
  coverage.push_back(std::move(covered));
}

std::shared_ptr<Primitive> random_triangles(std::uint32_t count, float size, std::uint32_t seed) {
  std::mt19937 random(seed);
  auto primitive = std::make_shared<Primitive>();
  for (std::uint32_t i = 0; i < 3 * count; i += 3) {
    const glm::vec3 center = 20.0f * uniform_3(random) - 10.0f;
    for (std::uint32_t k = 0; k < 3; ++k) {
      primitive->positions.push_back(center + size * (2.0f * uniform_3(random) - 1.0f));
      primitive->uv0.push_back({4.0f * uniform(random) - 2.0f, 4.0f * uniform(random) - 2.0f});
      primitive->indices.push_back(i + k);
    }
  }
  fill_bounds(*primitive);
  return primitive;
}

std::shared_ptr<Primitive> bumpy_shell(std::uint32_t side) {
  return grid(side, [](glm::vec2 st) {
    // The seam's and the poles' vertices coincide in every bit, or the shell would not be closed.
    const float a = st.y > 0.0f && st.y < 1.0f && st.x < 1.0f ? glm::two_pi<float>() * st.x : 0.0f;
    const float b = glm::pi<float>() * st.y;
    const float radius =
        8.0f + 1.5f * std::sin(5.0f * a) * std::sin(7.0f * b) + 0.5f * std::sin(31.0f * a) * std::cos(23.0f * b);
    return radius * glm::vec3(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
  });
}

std::shared_ptr<Primitive> terrain(std::uint32_t side) {
  return grid(side, [](glm::vec2 st) {
    const glm::vec2 p = 20.0f * st - 10.0f;
    const float height = 1.3f * std::sin(0.9f * p.x) * std::cos(0.7f * p.y) + 0.2f * std::sin(5.0f * p.x + 3.0f * p.y);
    return glm::vec3(p.x, height, p.y);
  });
}

std::vector<Ray> random_rays(const TraceWorld& world, std::uint32_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Ray> rays;
  rays.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 origin = world.bounds_min + (world.bounds_max - world.bounds_min) * uniform_3(random);
    rays.push_back({origin, 0.0f, on_sphere(random), kFar});
  }
  return rays;
}

std::vector<Ray> camera_rays(glm::vec3 eye, std::uint32_t width_px) {
  std::vector<Ray> rays;
  rays.reserve(std::size_t{width_px} * width_px);
  for (std::uint32_t y = 0; y < width_px; ++y)
    for (std::uint32_t x = 0; x < width_px; ++x) {
      const glm::vec2 ndc = (glm::vec2(x, y) + 0.5f) / static_cast<float>(width_px) * 2.0f - 1.0f;
      rays.push_back({eye, 0.0f, glm::normalize(glm::vec3(ndc.x, -ndc.y, -1.0f)), kFar});
    }
  return rays;
}

std::vector<Ray> diffuse_rays(const TraceWorld& world, const std::vector<Ray>& first, const std::vector<Hit>& hits,
                              std::uint32_t per_point, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].t < 0.0f) continue;
    const Instance& instance = world.instances[hits[i].instance];
    const auto corner = [&](std::uint32_t k) {
      const glm::vec3 p = instance.primitive->positions[instance.primitive->indices[3 * hits[i].triangle + k]];
      return glm::vec3(instance.world_from_object * glm::vec4(p, 1.0f));
    };
    glm::vec3 normal = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    if (glm::dot(normal, first[i].direction_ws) > 0.0f) normal = -normal;
    const glm::vec3 origin = first[i].origin_ws + hits[i].t * first[i].direction_ws + 1e-3f * normal;
    for (std::uint32_t k = 0; k < per_point; ++k)
      rays.push_back({origin, 0.0f, glm::normalize(normal + 0.999f * on_sphere(random)), kFar});
  }
  return rays;
}

BruteHit brute_force(const TraceWorld& world, const Ray& ray) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  BruteHit best{{kMiss, 0, 0, 0.0f, 0.0f}, kInfinite};
  double nearest = kInfinite;
  const glm::dvec3 origin(ray.origin_ws), direction(ray.direction_ws);
  for (std::uint32_t i = 0; i < world.instances.size(); ++i) {
    const Instance& instance = world.instances[i];
    const Primitive& primitive = *instance.primitive;
    const std::span<const glm::vec3> positions = positions_of(instance);
    const glm::dmat4 world_from_object(instance.world_from_object);
    for (std::uint32_t triangle = 0; triangle < primitive.indices.size() / 3; ++triangle) {
      const auto corner = [&](std::uint32_t k) {
        const glm::dvec3 p(positions[primitive.indices[3 * triangle + k]]);
        return glm::dvec3(world_from_object * glm::dvec4(p, 1.0));
      };
      // "Fast, Minimum Storage Ray/Triangle Intersection", Moeller and Trumbore 1997.
      const glm::dvec3 a = corner(0), edge_1 = corner(1) - a, edge_2 = corner(2) - a;
      const glm::dvec3 p = glm::cross(direction, edge_2);
      const double determinant = glm::dot(edge_1, p);
      if (determinant == 0.0) continue;
      const double u = glm::dot(origin - a, p) / determinant;
      const glm::dvec3 q = glm::cross(origin - a, edge_1);
      const double v = glm::dot(direction, q) / determinant;
      const double t = glm::dot(edge_2, q) / determinant;
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || !(t > ray.t_min && t < ray.t_max)) continue;
      if (t < nearest) {
        best.second_t = nearest;
        nearest = t;
        best.hit = {static_cast<float>(t), i, triangle, static_cast<float>(u), static_cast<float>(v)};
      } else {
        best.second_t = std::min(best.second_t, t);
      }
    }
  }
  return best;
}

PlaneDistance plane_distance(const TraceWorld& world, const Ray& ray, const Hit& hit) {
  const Instance& instance = world.instances.at(hit.instance);
  const Primitive& primitive = *instance.primitive;
  const std::span<const glm::vec3> positions = positions_of(instance);
  const glm::dmat4 world_from_object(instance.world_from_object);
  const glm::dvec3 origin(ray.origin_ws), direction(ray.direction_ws);
  glm::dvec3 largest = glm::abs(origin), corners[3];
  for (std::uint32_t k = 0; k < 3; ++k) {
    const glm::dvec3 p(positions[primitive.indices.at(3 * hit.triangle + k)]);
    corners[k] = glm::dvec3(world_from_object * glm::dvec4(p, 1.0));
    largest = glm::max(largest, glm::max(glm::abs(p), glm::abs(corners[k])));
  }
  const glm::dvec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double cosine = glm::dot(normal, direction);
  return {glm::dot(normal, corners[0] - origin) / cosine, std::abs(cosine),
          std::max({largest.x, largest.y, largest.z})};
}

}  // namespace lightwell::test
