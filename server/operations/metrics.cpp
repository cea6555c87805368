#include "server/operations/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <unistd.h>

#include <fstream>
#include <limits>

namespace lightwell {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;

/// Seconds: from a tenth of a millisecond, each bound double the last.
Histogram::BucketBoundaries doubling_seconds(int count) {
  Histogram::BucketBoundaries bounds;
  for (double bound = 1e-4; count > 0; --count, bound *= 2) bounds.push_back(bound);
  return bounds;
}

const Histogram::BucketBoundaries kStageSeconds = doubling_seconds(15);    // to 1.6 s
const Histogram::BucketBoundaries kRequestSeconds = doubling_seconds(20);  // to 52 s

const char* label_of(Purpose purpose) {
  return purpose == Purpose::kStream ? "stream" : "request";
}

const char* label_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInvalidInput:
      return "invalid_input";
    case ErrorKind::kNotFound:
      return "not_found";
    case ErrorKind::kTooLarge:
      return "too_large";
    case ErrorKind::kUnsupported:
      return "unsupported";
    case ErrorKind::kNoDevice:
      return "no_device";
    case ErrorKind::kDeviceLost:
      return "device_lost";
    case ErrorKind::kUnwanted:  // counted by themselves
    case ErrorKind::kInternal:
      break;
  }
  return "internal";
}

/// /proc/self/statm's second number: the pages in memory.
double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double all_pages = 0.0, resident_pages = 0.0;
  file >> all_pages >> resident_pages;
  return resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

/// A number for each codec.
struct ByCodec {
  explicit ByCodec(Family<Counter>& family)
      : jpeg(family.Add({{"codec", "jpeg"}})), h264(family.Add({{"codec", "h264"}})) {}
  Counter& of(PictureCodec codec) { return codec == PictureCodec::kH264 ? h264 : jpeg; }

  Counter &jpeg, &h264;
};

}  // namespace

struct Metrics::State {
  Family<Counter>& counters(const char* name, const char* help) {
    return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
  }
  Family<Gauge>& gauges(const char* name, const char* help) {
    return prometheus::BuildGauge().Name(name).Help(help).Register(registry);
  }
  Family<Histogram>& histograms(const char* name, const char* help) {
    return prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
  }

  prometheus::Registry registry;
  Family<Counter>& frames = counters("lightwell_frames_total", "Frames rendered, by what they were for");
  Family<Counter>& failures = counters("lightwell_frame_failures_total", "Frames that failed, by the kind of error");
  Counter& unwanted = counters("lightwell_frames_given_up_total", "Frames given up for an input that came").Add({});
  Family<Histogram>& frame_time = histograms("lightwell_frame_seconds", "Time of a whole frame on the render thread");
  Family<Histogram>& stage_time = histograms("lightwell_stage_seconds", "Time of a frame's stages on the device");
  Counter& rays = counters("lightwell_rays_total", "Rays traced").Add({});
  Histogram& encode_time =
      histograms("lightwell_encode_seconds", "Time to encode a stream's picture").Add({}, kStageSeconds);
  ByCodec encoded{counters("lightwell_pictures_encoded_total", "Pictures encoded for streams")};
  ByCodec not_encoded{counters("lightwell_encode_failures_total", "Pictures of streams that could not be encoded")};
  ByCodec encoded_bytes{counters("lightwell_encoded_bytes_total", "Bytes of pictures encoded for streams")};
  ByCodec sent{counters("lightwell_pictures_sent_total", "Pictures sent to viewers")};
  ByCodec sent_bytes{counters("lightwell_sent_bytes_total", "Bytes of pictures sent to viewers")};
  Histogram& acknowledge_time =
      histograms("lightwell_acknowledge_seconds", "From a picture's being sent to its being acknowledged")
          .Add({}, kRequestSeconds);
  Family<Counter>& requests = counters("lightwell_requests_total", "HTTP requests answered");
  Family<Histogram>& request_time =
      histograms("lightwell_request_seconds", "Time from a request's being read to its answer");
  Counter& received = counters("lightwell_received_bytes_total", "Bytes of request bodies").Add({});
  Counter& rebuilds = counters("lightwell_device_rebuilds_total", "Times the lost device was set up again").Add({});
  Family<Counter>& task_failures =
      counters("lightwell_background_failures_total", "Times that work which nobody waits for has failed, by task");
  Counter& taken_up = counters("lightwell_sessions_taken_up_total", "Sessions of other servers taken up").Add({});
  Gauge& sessions = gauges("lightwell_sessions", "Sessions").Add({});
  Gauge& viewers = gauges("lightwell_viewers", "Streams that are open").Add({});
  Gauge& connections = gauges("lightwell_connections", "Connections that are open").Add({});
  Gauge& renders_waiting = gauges("lightwell_renders_waiting", "Requests for pictures not answered yet").Add({});
  Gauge& frames_waiting = gauges("lightwell_sequence_frames_waiting", "Frames of sequences not rendered yet").Add({});
  Gauge& scenes = gauges("lightwell_uploaded_scenes", "Scenes that were uploaded").Add({});
  Gauge& scene_bytes = gauges("lightwell_uploaded_scene_bytes", "Bytes of the scenes that were uploaded").Add({});
  Gauge& ready = gauges("lightwell_ready", "1 while pictures can be asked for").Add({});
  Gauge& resident = gauges("process_resident_memory_bytes", "Resident memory of the process").Add({});
  Gauge& device_total =
      gauges("lightwell_device_memory_bytes", "Memory of the graphics device; 0: it does not tell").Add({});
  Gauge& device_own =
      gauges("lightwell_device_memory_own_bytes", "Bytes in this server's textures and buffers on the device").Add({});
  Gauge& device_used = gauges("lightwell_device_memory_used_bytes", "Of it, what is in use, by everyone").Add({});
};

Metrics::Metrics() : state_(std::make_unique<State>()) {
  for (const char* task : {"sessions", "kept_sessions", "session_writing", "sequences", "sequence_frames"})
    state_->task_failures.Add({{"task", task}});  // 0 from the start: the first failure is a rise that alerts see
}

Metrics::~Metrics() = default;

void Metrics::frame_rendered(const Frame& frame, Purpose purpose, double seconds) {
  state_->frames.Add({{"for", label_of(purpose)}}).Increment();
  state_->frame_time.Add({{"for", label_of(purpose)}}, kStageSeconds).Observe(seconds);
  state_->rays.Increment(static_cast<double>(frame.rays));
  for (const StageTime& stage : frame.stages)
    state_->stage_time.Add({{"stage", std::string(stage.name)}}, kStageSeconds).Observe(stage.ms * 1e-3);
}

void Metrics::frame_failed(ErrorKind kind) {
  if (kind == ErrorKind::kUnwanted) return state_->unwanted.Increment();
  state_->failures.Add({{"kind", label_of(kind)}}).Increment();
}

void Metrics::picture_encoded(double seconds, const EncodedBytes& bytes) {
  state_->encode_time.Observe(seconds);
  for (const auto& [codec, size] : {std::pair(PictureCodec::kJpeg, bytes.jpeg), {PictureCodec::kH264, bytes.h264}}) {
    if (size == 0) continue;
    state_->encoded.of(codec).Increment();
    state_->encoded_bytes.of(codec).Increment(static_cast<double>(size));
  }
}

void Metrics::encoding_failed(PictureCodec codec) {
  state_->not_encoded.of(codec).Increment();
}

void Metrics::picture_sent(PictureCodec codec, std::uint64_t bytes) {
  state_->sent.of(codec).Increment();
  state_->sent_bytes.of(codec).Increment(static_cast<double>(bytes));
}

void Metrics::picture_acknowledged(double seconds) {
  state_->acknowledge_time.Observe(seconds);
}

void Metrics::request_answered(std::string_view method, std::string_view route, int status, double seconds) {
  const prometheus::Labels where{{"method", std::string(method)}, {"route", std::string(route)}};
  prometheus::Labels what = where;
  what.emplace("status", std::to_string(status));
  state_->requests.Add(what).Increment();
  state_->request_time.Add(where, kRequestSeconds).Observe(seconds);
}

void Metrics::bytes_received(std::uint64_t bytes) {
  state_->received.Increment(static_cast<double>(bytes));
}

void Metrics::device_memory(const gl::DeviceMemory& memory) {
  state_->device_total.Set(static_cast<double>(memory.total_bytes));
  state_->device_used.Set(static_cast<double>(memory.used_bytes));
  state_->device_own.Set(static_cast<double>(memory.own_bytes));
}

void Metrics::device_rebuilt() {
  state_->rebuilds.Increment();
}

void Metrics::background_task_failed(std::string_view task) {
  state_->task_failures.Add({{"task", std::string(task)}}).Increment();
}

void Metrics::session_taken_up() {
  state_->taken_up.Increment();
}

std::string Metrics::exposition(const Levels& levels) const {
  const std::pair<Gauge&, std::uint64_t> values[] = {
      {state_->sessions, levels.sessions},       {state_->viewers, levels.viewers},
      {state_->connections, levels.connections}, {state_->renders_waiting, levels.renders_waiting},
      {state_->scenes, levels.uploaded_scenes},  {state_->scene_bytes, levels.uploaded_bytes},
      {state_->ready, levels.ready ? 1u : 0u}};
  for (const auto& [gauge, value] : values) gauge.Set(static_cast<double>(value));
  state_->frames_waiting.Set(levels.frames_waiting ? static_cast<double>(*levels.frames_waiting)
                                                   : std::numeric_limits<double>::quiet_NaN());
  state_->resident.Set(resident_bytes());
  return prometheus::TextSerializer().Serialize(state_->registry.Collect());
}

}  // namespace lightwell
