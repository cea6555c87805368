#include "renderer/gl/device.h"

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>

#include "renderer/gl/gl.h"

namespace lightwell::gl {

namespace {

constexpr int kSurfaceless = -1;

template <class Function>
Function egl_function(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

bool has_word(const char* list, std::string_view word) {
  const std::string padded = " " + std::string(list ? list : "") + " ";
  return padded.find(" " + std::string(word) + " ") != std::string::npos;
}

std::vector<EGLDeviceEXT> query_devices() {
  const auto query = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  EGLint count = 0;
  if (!query || !query(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (!query(count, devices.data(), &count)) return {};
  devices.resize(static_cast<std::size_t>(std::max(count, 0)));
  return devices;
}

std::string egl_error(const char* call) {
  char code[16];
  std::snprintf(code, sizeof code, "0x%04x", static_cast<unsigned>(eglGetError()));
  return std::string(call) + " failed (" + code + ")";
}

// An EGL display with a current OpenGL 4.5 core context, or the reason why there is none.
struct Session {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  DeviceInfo info;

  void close() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
    display = EGL_NO_DISPLAY;
    context = EGL_NO_CONTEXT;
  }
};

EGLDisplay open_display(const std::vector<EGLDeviceEXT>& devices, int index) {
  const auto get_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (!get_display) return EGL_NO_DISPLAY;
  if (index == kSurfaceless) return get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  return get_display(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(index)], nullptr);
}

void name_device(const std::vector<EGLDeviceEXT>& devices, DeviceInfo& info) {
  if (info.index == kSurfaceless) {
    info.egl_name = "Mesa surfaceless platform";
    return;
  }
  const auto query_string = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  const char* extensions =
      query_string ? query_string(devices[static_cast<std::size_t>(info.index)], EGL_EXTENSIONS) : nullptr;
  info.software = has_word(extensions, "EGL_MESA_device_software");
  info.egl_name = info.software ? "software device" : "device";
  if (has_word(extensions, "EGL_EXT_device_drm")) {
    const char* file = query_string(devices[static_cast<std::size_t>(info.index)], EGL_DRM_DEVICE_FILE_EXT);
    if (file) info.egl_name += std::string(" ") + file;
  }
}

// Makes a context current on this thread. Never throws; `info.usable` tells.
Session open_session(const std::vector<EGLDeviceEXT>& devices, int index) {
  Session session;
  session.info.index = index;
  name_device(devices, session.info);
  const auto fail = [&](std::string reason) {
    session.info.reason = std::move(reason);
    session.close();
    return session;
  };
  session.display = open_display(devices, index);
  if (session.display == EGL_NO_DISPLAY) return fail("EGL gives no display for it");
  if (!eglInitialize(session.display, nullptr, nullptr)) {
    session.display = EGL_NO_DISPLAY;
    return fail(egl_error("eglInitialize"));
  }
  const char* extensions = eglQueryString(session.display, EGL_EXTENSIONS);
  if (!has_word(extensions, "EGL_KHR_surfaceless_context")) return fail("no EGL_KHR_surfaceless_context");
  if (!eglBindAPI(EGL_OPENGL_API)) return fail(egl_error("eglBindAPI(EGL_OPENGL_API)"));
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!has_word(extensions, "EGL_KHR_no_config_context")) {
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(session.display, wanted, &config, 1, &count) || count < 1)
      return fail(egl_error("eglChooseConfig"));
  }
  std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION,       4,
                                    EGL_CONTEXT_MINOR_VERSION,       5,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                    EGL_CONTEXT_OPENGL_DEBUG,        EGL_TRUE};
  if (has_word(extensions, "EGL_EXT_create_context_robustness"))
    attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
  attributes.push_back(EGL_NONE);
  session.context = eglCreateContext(session.display, config, EGL_NO_CONTEXT, attributes.data());
  if (session.context == EGL_NO_CONTEXT) return fail(egl_error("eglCreateContext for OpenGL 4.5 core"));
  if (!eglMakeCurrent(session.display, EGL_NO_SURFACE, EGL_NO_SURFACE, session.context))
    return fail(egl_error("eglMakeCurrent"));
  const auto text = [](GLenum name) {
    const GLubyte* value = glGetString(name);
    return std::string(value ? reinterpret_cast<const char*>(value) : "");
  };
  session.info.gl_renderer = text(GL_RENDERER);
  session.info.gl_version = text(GL_VERSION);
  for (const char* name : {"llvmpipe", "softpipe", "SwiftShader", "swrast"})
    if (session.info.gl_renderer.find(name) != std::string::npos) session.info.software = true;
  session.info.usable = true;
  return session;
}

std::string list_reasons(const std::vector<DeviceInfo>& devices) {
  std::string text;
  for (const DeviceInfo& device : devices) {
    text += "\n  " + (device.index == kSurfaceless ? std::string("-") : std::to_string(device.index)) + ": " +
            device.egl_name + ": " + (device.usable ? "usable: " + device.gl_renderer : device.reason);
  }
  return text.empty() ? "\n  EGL lists no device" : text;
}

struct Chosen {
  Session session;
  std::string why;
};

Chosen choose_index(const std::vector<EGLDeviceEXT>& devices, const std::string& request) {
  int index = 0;
  const auto [end, error] = std::from_chars(request.data(), request.data() + request.size(), index);
  if (error != std::errc{} || end != request.data() + request.size())
    throw NoDevice("--device takes an index or \"software\", not \"" + request + "\"");
  if (index < 0 || index >= static_cast<int>(devices.size()))
    throw NoDevice("there is no EGL device " + request + ": " + std::to_string(devices.size()) + " are listed");
  Session session = open_session(devices, index);
  if (!session.info.usable) throw NoDevice("EGL device " + request + " cannot be used: " + session.info.reason);
  return {std::move(session), "asked for by index"};
}

// First pass: GPUs only. Second: the software device, by surfaceless last.
Chosen choose(const std::string& request) {
  const std::vector<EGLDeviceEXT> devices = query_devices();
  const bool want_software = request == "software";
  if (!request.empty() && !want_software) return choose_index(devices, request);
  std::vector<DeviceInfo> tried;
  std::vector<int> software_devices;
  for (int index = 0; index < static_cast<int>(devices.size()); ++index) {
    DeviceInfo named;
    named.index = index;
    name_device(devices, named);
    if (named.software) {
      software_devices.push_back(index);
      continue;
    }
    if (want_software) continue;
    Session session = open_session(devices, index);
    if (session.info.usable && !session.info.software) return {std::move(session), "the first GPU that works"};
    if (session.info.usable) software_devices.push_back(index);
    tried.push_back(session.info);
    session.close();
  }
  software_devices.push_back(kSurfaceless);
  for (const int index : software_devices) {
    Session session = open_session(devices, index);
    if (session.info.usable && (session.info.software || !want_software))
      return {std::move(session), want_software ? "asked for" : "no GPU can be used, so the software device"};
    tried.push_back(session.info);
    session.close();
  }
  throw NoDevice("no device gives an OpenGL 4.5 core context; tried:" + list_reasons(tried));
}

struct DebugLog {
  std::mutex mutex;
  std::vector<std::string> messages;
};

void APIENTRY on_debug_message(GLenum, GLenum, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                               const void* user) {
  if (severity != GL_DEBUG_SEVERITY_HIGH && severity != GL_DEBUG_SEVERITY_MEDIUM) return;
  constexpr std::size_t kMostMessages = 64;
  auto* log = static_cast<DebugLog*>(const_cast<void*>(user));
  const std::lock_guard lock(log->mutex);
  if (log->messages.size() < kMostMessages) log->messages.emplace_back(text, static_cast<std::size_t>(length));
}

}  // namespace

void share_processors_evenly() {
  constexpr int kKeepWhatIsSet = 0;
  const unsigned threads = 2 * std::max(1u, std::thread::hardware_concurrency());
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), kKeepWhatIsSet);
}

std::vector<DeviceInfo> enumerate_devices() {
  const std::vector<EGLDeviceEXT> devices = query_devices();
  std::vector<DeviceInfo> infos;
  for (int index = 0; index <= static_cast<int>(devices.size()); ++index) {
    const bool last = index == static_cast<int>(devices.size());
    Session session = open_session(devices, last ? kSurfaceless : index);
    infos.push_back(session.info);
    session.close();
  }
  return infos;
}

struct Context::State {
  Session session;
  std::string why;
  DebugLog log;
};

Context::Context() : state_(std::make_unique<State>()) {}

std::unique_ptr<Context> Context::create(const DeviceChoice& choice) {
  Chosen chosen = choose(choice.request);
  std::unique_ptr<Context> context(new Context);
  context->state_->session = std::move(chosen.session);
  context->state_->why = std::move(chosen.why);
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(on_debug_message, &context->state_->log);
  return context;
}

Context::~Context() {
  glDebugMessageCallback(nullptr, nullptr);
  state_->session.close();
}

const DeviceInfo& Context::device() const {
  return state_->session.info;
}

const std::string& Context::why() const {
  return state_->why;
}

std::vector<std::string> Context::take_debug_messages() {
  const std::lock_guard lock(state_->log.mutex);
  return std::exchange(state_->log.messages, {});
}

bool Context::lost() const {
  return glGetGraphicsResetStatus() != GL_NO_ERROR;
}

}  // namespace lightwell::gl
