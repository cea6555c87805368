#include "server/stream/audience.h"

#include <algorithm>
#include <atomic>

namespace lightwell {
namespace {

constexpr int kMostInTheMaking = 2;  // one is rendered while another is encoded

}  // namespace

Audience::Audience()
    : source_([] {
        static std::atomic<std::uint64_t> sources = 0;
        return ++sources;
      }()) {}

bool Audience::join(std::shared_ptr<Viewer> viewer, std::size_t most) {
  std::lock_guard lock(mutex_);
  if (viewers_.size() >= most) return false;
  viewers_.push_back(std::move(viewer));
  return true;
}

void Audience::show_latest(Viewer& viewer, std::uint64_t revision) const {
  std::shared_ptr<const Picture> latest;
  {
    std::lock_guard lock(mutex_);
    latest = latest_;
  }
  if (latest && latest->revision == revision) viewer.offer(std::move(latest));
}

void Audience::leave(const Viewer& viewer) {
  std::shared_ptr<Viewer> left;  // let go of after the lock
  std::lock_guard lock(mutex_);
  const auto found = std::find_if(viewers_.begin(), viewers_.end(), [&](const auto& v) { return v.get() == &viewer; });
  if (found == viewers_.end()) return;
  left = std::move(*found);
  viewers_.erase(found);
}

std::size_t Audience::size() const {
  std::lock_guard lock(mutex_);
  return viewers_.size();
}

bool Audience::wants_picture(int in_the_making) const {
  if (in_the_making >= kMostInTheMaking) return false;
  const auto all = spectators();
  return std::any_of(all.begin(), all.end(), [&](const auto& viewer) { return viewer->takes_another(in_the_making); });
}

LinkPace Audience::pace() const {
  const auto all = spectators();
  const Viewer* first = leader(all);
  return first ? first->pace() : LinkPace();
}

PictureNeed Audience::need() const {
  PictureNeed need;
  const auto all = spectators();
  const Viewer* first = leader(all);
  for (const auto& viewer : all) {
    const PictureNeed one = viewer->need();
    if (viewer.get() == first) need.is_paced_by_video = one.video;
    need.jpeg = need.jpeg || one.jpeg;
    need.video = need.video || one.video;
    need.key = need.key || one.key;
  }
  return need;
}

void Audience::demote(const protocol::Problem& problem) {
  for (const auto& viewer : spectators()) viewer->demote(problem);
}

void Audience::show(std::shared_ptr<const Picture> picture) {
  {
    std::lock_guard lock(mutex_);
    if (latest_ && latest_->number > picture->number) return;
    latest_ = picture;
  }
  for (const auto& viewer : viewers()) viewer->offer(picture);
}

void Audience::tell_change(unsigned members, const Viewer* by, std::uint32_t seq) {
  for (const auto& viewer : viewers())
    viewer->state_changed(members, viewer.get() == by ? std::optional(seq) : std::nullopt);
}

void Audience::report(const protocol::Problem& problem) {
  for (const auto& viewer : viewers()) viewer->report(problem);
}

void Audience::end(protocol::CloseCode code, const std::string& reason, bool reconnect) {
  for (const auto& viewer : viewers()) viewer->end(code, reason, reconnect);
}

void Audience::end_resumed(const std::string& resume_token) {
  for (const auto& viewer : viewers())
    if (viewer->resume_token() == resume_token)
      viewer->end(protocol::CloseCode::kSessionEnded, "resumed by another connection", false);
}

void Audience::check_patience(SteadyTime now) {
  for (const auto& viewer : viewers()) viewer->check_patience(now);
}

/// Those who see this audience's pictures.
std::vector<std::shared_ptr<Viewer>> Audience::spectators() const {
  std::vector<std::shared_ptr<Viewer>> all = viewers();
  std::erase_if(all, [&](const auto& viewer) { return viewer->source() != source_; });
  return all;
}

/// Whose link pictures are made for: the driver, or who came first; null if nobody is there.
const Viewer* Audience::leader(const std::vector<std::shared_ptr<Viewer>>& spectators) {
  const auto driver =
      std::find_if(spectators.begin(), spectators.end(), [](const auto& viewer) { return viewer->drives(); });
  if (driver != spectators.end()) return driver->get();
  return spectators.empty() ? nullptr : spectators.front().get();
}

std::vector<std::shared_ptr<Viewer>> Audience::viewers() const {
  std::lock_guard lock(mutex_);
  return viewers_;
}

}  // namespace lightwell
