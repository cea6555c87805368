#include "server/command_line/thesis/picture_options.h"

#include "server/command_line/add_option.h"
#include "server/command_line/settings_options.h"
#include "server/command_line/thesis/frame_request.h"

namespace lightwell {

void add_picture_options(CLI::App& app, int& side_px, Settings& settings, std::string& device, std::string& tracer) {
  add_integer(app, "--side", side_px, kLeastSide_px, kMostSide_px,
              "The pictures' side in pixels; indirect maps keep their share of it");
  app.option_defaults()->group("Light");
  add_thesis_options(app, settings);
  add_device_options(app, device, tracer);
}

Status check_picture_options(int side_px, const Settings& settings) {
  const Status status = check_settings(settings, glm::ivec2(side_px));
  if (!status) return Error{status.error().kind, "--" + status.error().where, status.error().what};
  return Done{};
}

}  // namespace lightwell
