#include "server/command_line/devices_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "server/command_line/device_report.h"

namespace lightwell {

namespace {

struct Choice {
  nlohmann::json chosen;  // the device with "why", or null
  std::string line;
};

Choice choose() {
  try {
    const auto context = gl::Context::create();
    nlohmann::json chosen = to_json(context->device());
    chosen["why"] = context->why();
    return {std::move(chosen), "chosen: " + short_name(context->device()) + ", " + context->device().gl_renderer +
                                   " (" + context->why() + ")"};
  } catch (const gl::NoDevice& error) {
    return {nullptr, std::string("none chosen: ") + error.what()};
  }
}

void print_text(const std::vector<gl::DeviceInfo>& devices, const Choice& choice) {
  for (const gl::DeviceInfo& device : devices) {
    const std::string found =
        device.usable ? device.gl_renderer + ", OpenGL " + device.gl_version + (device.software ? ", on the CPU" : "")
                      : "not usable: " + device.reason;
    std::printf("%s\n    %s\n", short_name(device).c_str(), found.c_str());
  }
  std::printf("%s\n", choice.line.c_str());
}

}  // namespace

nlohmann::json to_json(const gl::DeviceInfo& device) {
  nlohmann::json json = {{"egl_name", device.egl_name},     {"gl_renderer", device.gl_renderer},
                         {"gl_version", device.gl_version}, {"software", device.software},
                         {"usable", device.usable},         {"reason", device.reason}};
  json["index"] = device.index >= 0 ? nlohmann::json(device.index) : nlohmann::json(nullptr);
  return json;
}

std::string short_name(const gl::DeviceInfo& device) {
  return (device.index >= 0 ? std::to_string(device.index) : "-") + ": " + device.egl_name;
}

void add_devices_options(CLI::App& app, DevicesArguments& arguments) {
  app.add_flag("--json", arguments.json, "Print JSON");
}

ExitCode run_devices(const DevicesArguments& arguments) {
  const std::vector<gl::DeviceInfo> devices = gl::enumerate_devices();
  const Choice choice = choose();
  if (arguments.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const gl::DeviceInfo& device : devices) list.push_back(to_json(device));
    std::printf("%s\n", nlohmann::json{{"devices", list}, {"chosen", choice.chosen}}.dump(2).c_str());
  } else {
    print_text(devices, choice);
  }
  if (!choice.chosen.is_null()) return kDone;
  std::fprintf(stderr, "lightwell: %s\n", choice.line.c_str());
  return kNoUsableDevice;
}

}  // namespace lightwell
