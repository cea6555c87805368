// Headless OpenGL 4.5 core through EGL: enumerate the devices, try each, take the first GPU, else the software device.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace lightwell::gl {

/// One EGL device that was tried.
struct DeviceInfo {
  int index = -1;           // of eglQueryDevicesEXT; -1 for Mesa's surfaceless platform, tried last
  std::string egl_name;     // vendor or extensions as EGL tells them
  std::string gl_renderer;  // GL_RENDERER, empty if no context could be made
  std::string gl_version;
  bool software = false;  // runs on the CPU
  bool usable = false;    // an OpenGL 4.5 core context was made
  std::string reason;     // why it is not usable; empty if it is
};

/// What the operator asked for: "" (choose), "software", or a device's index in decimal.
struct DeviceChoice {
  std::string request;
};

/// No usable device: exit code 4. `what()` tells every device tried and why it failed.
class NoDevice : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Mesa's software device gives each of its threads an equal part of a compute dispatch and waits for the last. With
/// two threads a processor, one that finishes early takes over what another has not come to; a number that the
/// environment names stays. Changes the environment: before there are other threads.
void share_processors_evenly();

/// Tries every device; never throws and never crashes without one.
std::vector<DeviceInfo> enumerate_devices();

/// A context, current on the thread that made it until it is destroyed there.
class Context {
 public:
  /// Throws NoDevice.
  static std::unique_ptr<Context> create(const DeviceChoice& choice = {});
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const DeviceInfo& device() const;
  /// Why this device: "the first GPU", "no GPU found: ...", "asked for".
  const std::string& why() const;

  /// High and medium severity messages of the GL debug callback since the last call. Tests fail on any.
  std::vector<std::string> take_debug_messages();

  /// Not GL_NO_ERROR after a lost device (robust context): the renderer must be rebuilt.
  bool lost() const;

 private:
  Context();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightwell::gl
