#include "server/command_line/environment_options.h"

#include <glm/trigonometric.hpp>

#include "server/command_line/add_option.h"

namespace lightwell {

namespace {

constexpr double kMostStrength = 1e6;

Result<std::optional<float>> parse_rotation(const std::string& text) {
  const Result<double> degrees = parse_number(text, -3600.0, 3600.0);
  if (!degrees) return degrees.error();
  return std::optional<float>(static_cast<float>(glm::radians(*degrees)));
}

Result<std::optional<float>> parse_strength(const std::string& text) {
  const Result<double> strength = parse_number(text, 0.0, kMostStrength);
  if (!strength) return strength.error();
  return std::optional<float>(static_cast<float>(*strength));
}

}  // namespace

void add_environment_options(CLI::App& app, EnvironmentChoice& choice) {
  app.add_option("--environment", choice.file,
                 "Light from all around: a latitude-longitude picture, .hdr or .exr, instead of the scene's own sky")
      ->type_name("FILE");
  add_parsed(app, "--environment-rotation", choice.rotation, parse_rotation, "DEGREES",
             "Turns the environment about the vertical axis");
  add_parsed(
      app, "--environment-strength", choice.strength, parse_strength, "FACTOR",
      "Scales the environment's light; 0: the scene's own lamps alone, without the sky that dark scenes are given");
}

}  // namespace lightwell
