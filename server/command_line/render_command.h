// `lightwell render SCENE -o FILE`: pictures without a server.
#pragma once

#include <optional>
#include <string>

#include "renderer/image_io/environment_file.h"
#include "renderer/renderer.h"
#include "server/command_line/camera_argument.h"
#include "server/command_line/exit_code.h"
#include "server/command_line/parse_values.h"

namespace CLI {
class App;
}

namespace lightwell {

struct RenderArguments {
  std::string scene;
  std::string output;  // .exr, .png or .jpg; with `frames` it holds %d or %0Nd
  glm::ivec2 size_px{512, 512};
  int spp = 1;  // frames that are accumulated into one picture
  double time_s = 0.0;
  std::optional<FrameRange> frames;
  double fps = 30.0;
  CameraArgument camera;
  Settings settings;
  EnvironmentChoice environment;
  std::string device, tracer;
  bool json = false;
};

void add_render_options(CLI::App& app, RenderArguments& arguments);

/// Throws gl::NoDevice, or std::runtime_error when the renderer cannot start.
ExitCode run_render(const RenderArguments& arguments);

}  // namespace lightwell
