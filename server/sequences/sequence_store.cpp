#include "server/sequences/sequence_store.h"

#include "protocol/codec.h"
#include "server/convert.h"
#include "server/operations/log.h"
#include "server/scenes/digest.h"

namespace lightwell {
namespace {

using protocol::Decoded;
using protocol::make_problem;
using protocol::Problem;
using protocol::SequenceState;

constexpr std::size_t kMostPlans = 16;  // kept ready
constexpr std::size_t kIdDigits = 32;   // 128 bits of SHA-256

std::int64_t unix_seconds() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// A lock on a mutex that every caller takes for a moment only.
using Lock = std::unique_lock<std::mutex>;

}  // namespace

SequenceStore::SequenceStore(const ServeOptions& options, const SceneStore& scenes, const SceneFiles& scene_files)
    : options_(options),
      scenes_(scenes),
      scene_files_(scene_files),
      folder_(std::filesystem::path(options.data_dir) / "sequences"),
      table_(std::filesystem::path(options.data_dir) / "sequences.sqlite") {}

Decoded<SequenceStore::Submitted> SequenceStore::submit(const protocol::SequenceRequest& request,
                                                        const RendererIdentity& renderer) {
  const auto source = scenes_.source(request.scene);
  if (!source) return no_such_scene(request.scene, 422, "/scene");
  auto plan = SequencePlan::make(request, source->scene, options_);
  if (!plan) return plan.problem();
  const std::string& digest = source->scene->digest();
  const nlohmann::json full = protocol::to_json((*plan)->request());
  Digest identity;
  identity.add(protocol::json_text(full));
  identity.add(digest);
  identity.add(renderer);
  const std::string id = identity.hex().substr(0, kIdDigits);

  const auto known = table_.find(id);
  const bool takes_room = !known || known->sequence.state != SequenceState::kDone;
  if (takes_room && table_.bytes() > options_.limits.max_sequence_bytes)
    return make_problem(503, "the finished sequences take " + std::to_string(table_.bytes()) +
                                 " bytes, more than this server keeps; delete one first");
  if (const Status kept = scene_files_.keep(*source); !kept) return problem_of(kept.error());
  const bool begun = table_.submit(id, (*plan)->request(), full, digest);
  {
    Lock lock(mutex_);
    if (plans_.size() >= kMostPlans) plans_.clear();
    plans_[id] = *plan;
    if (begun) given_up_.erase(id);
    ++submitted_;
  }
  work_.notify_all();
  if (begun) log_event(LogLevel::kInfo, "sequence_submitted", {{"sequence", id}, {"scene", request.scene}});
  return Submitted{table_.find(id)->sequence, begun};
}

std::optional<protocol::Sequence> SequenceStore::find(const std::string& id) {
  const auto job = table_.find(id);
  if (!job) return {};
  return job->sequence;
}

bool SequenceStore::cancel(const std::string& id) {
  if (!table_.end(id, SequenceState::kCancelled, {})) return false;
  give_up(id);
  tell(id);
  return true;
}

bool SequenceStore::remove(const std::string& id) {
  table_.end(id, SequenceState::kCancelled, {});
  give_up(id);
  const bool was_there = forget(id);
  tell(id);
  return was_there;
}

bool SequenceStore::forget(const std::string& id) {
  const auto job = table_.find(id);
  if (!job || !table_.remove(id)) return false;
  folder_.remove(id);
  scene_files_.remove_if_unused(job->scene_digest);
  Lock lock(mutex_);
  plans_.erase(id);
  return true;
}

void SequenceStore::give_up(const std::string& id) {
  Lock lock(mutex_);
  if (const auto found = given_up_.find(id); found != given_up_.end()) *found->second = true;
  given_up_.erase(id);
}

std::shared_ptr<void> SequenceStore::listen(const std::string& id, std::function<void()> changed) {
  Lock lock(listeners_->mutex);
  const std::uint64_t number = listeners_->next++;
  listeners_->all[number] = {id, std::move(changed)};
  return {nullptr, [listeners = listeners_, number](void*) {
            Lock goodbye(listeners->mutex);
            listeners->all.erase(number);
          }};
}

void SequenceStore::tell(const std::string& id) {
  std::vector<std::function<void()>> calls;
  {
    Lock lock(listeners_->mutex);
    for (const auto& [number, listener] : listeners_->all)
      if (listener.id == id) calls.push_back(listener.changed);
  }
  for (const auto& call : calls) call();
}

std::optional<ClaimedFrame> SequenceStore::claim(std::chrono::milliseconds limit) {
  std::uint64_t seen = 0;
  {
    Lock lock(mutex_);
    if (stopping_) return {};
    seen = submitted_;
  }
  if (auto frame = table_.claim()) return frame;
  Lock lock(mutex_);
  work_.wait_for(lock, limit, [&] { return stopping_ || submitted_ != seen; });
  return {};
}

Decoded<std::shared_ptr<const SequencePlan>> SequenceStore::plan(const std::string& id) {
  {
    Lock lock(mutex_);
    if (const auto found = plans_.find(id); found != plans_.end()) return found->second;
  }
  const auto job = table_.find(id);
  if (!job) return make_problem(404, "there is no such sequence");
  const auto source = scene_files_.find(job->sequence.request.value("scene", std::string()), job->scene_digest);
  if (!source) return source.problem();
  const auto request = protocol::parse_sequence_request(protocol::json_text(job->sequence.request));
  if (!request) return request.problem();
  auto plan = SequencePlan::make(*request, source->scene, options_);
  if (!plan) return plan.problem();
  Lock lock(mutex_);
  if (plans_.size() >= kMostPlans) plans_.clear();
  return plans_[id] = *plan;
}

std::shared_ptr<std::atomic<bool>> SequenceStore::given_up(const std::string& id) {
  const auto state = table_.state(id);
  Lock lock(mutex_);
  std::shared_ptr<std::atomic<bool>>& flag = given_up_[id];
  if (!flag) flag = std::make_shared<std::atomic<bool>>(false);
  if (state != SequenceState::kRunning) *flag = true;
  return flag;
}

void SequenceStore::finish(const ClaimedFrame& frame, const std::vector<FrameFile>& files) {
  table_.finish(frame, files);
  tell(frame.sequence);
}

void SequenceStore::fail(const ClaimedFrame& frame, const Problem& problem) {
  const std::string& id = frame.sequence;
  table_.release(frame);
  log_event(LogLevel::kError, "sequence_failed", {{"sequence", id}, {"reason", problem.detail}});
  table_.end(id, SequenceState::kFailed, problem);
  give_up(id);
  tell(id);
}

void SequenceStore::keep_house() {
  table_.beat();
  const auto oldest_s = unix_seconds() - static_cast<std::int64_t>(options_.limits.sequence_keep_s);
  for (const std::string& id : table_.ended_before(oldest_s)) forget(id);
}

void SequenceStore::stop() {
  {
    Lock lock(mutex_);
    stopping_ = true;
  }
  work_.notify_all();
}

}  // namespace lightwell
