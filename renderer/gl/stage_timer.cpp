#include "renderer/gl/stage_timer.h"

#include <algorithm>
#include <utility>

#include "renderer/gl/buffer.h"

namespace lightwell::gl {

namespace {

void add(std::vector<StageTimer::Stage>& stages, std::string_view name, double ms) {
  const auto found = std::find_if(stages.begin(), stages.end(), [&](const auto& stage) { return stage.name == name; });
  if (found != stages.end())
    found->ms += ms;
  else
    stages.push_back({name, ms});
}

}  // namespace

StageTimer::~StageTimer() {
  glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

GLuint StageTimer::next_query() {
  if (used_queries_ == queries_.size()) {
    queries_.push_back(0);
    glCreateQueries(GL_TIMESTAMP, 1, &queries_.back());
  }
  return queries_[used_queries_++];
}

void StageTimer::begin_frame(std::function<bool()> is_unwanted) {
  is_unwanted_ = std::move(is_unwanted);
  stages_.clear();
  used_queries_ = 0;
  last_ = std::chrono::steady_clock::now();
  if (!software_) glQueryCounter(next_query(), GL_TIMESTAMP);
}

void StageTimer::mark(std::string_view name) {
  note_end(name);
  if (is_unwanted_ && is_unwanted_()) throw FrameUnwanted();
}

void StageTimer::note_end(std::string_view name) {
  if (!software_) {
    glQueryCounter(next_query(), GL_TIMESTAMP);
    stages_.push_back({name, 0.0});
    return;
  }
  wait_for_device();
  const auto now = std::chrono::steady_clock::now();
  add(stages_, name, std::chrono::duration<double, std::milli>(now - last_).count());
  last_ = now;
}

std::vector<StageTimer::Stage> StageTimer::end_frame() {
  if (software_) return stages_;
  std::vector<Stage> merged;
  GLuint64 before_ns = 0;
  for (std::size_t i = 0; i < used_queries_; ++i) {
    GLuint64 now_ns = 0;
    glGetQueryObjectui64v(queries_[i], GL_QUERY_RESULT, &now_ns);
    if (i > 0) add(merged, stages_[i - 1].name, static_cast<double>(now_ns - before_ns) * 1e-6);
    before_ns = now_ns;
  }
  return merged;
}

}  // namespace lightwell::gl
