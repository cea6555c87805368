// Viewers who see the same pictures, and the picture they were shown last.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "server/stream/viewer.h"

namespace lightwell {

/// Thread-safe. Calls viewers without its own lock.
class Audience {
 public:
  Audience();

  /// What its pictures are marked with; no other audience has it. A viewer may be in several, and sees one of them.
  std::uint64_t source() const { return source_; }

  /// False if there are `most` already.
  bool join(std::shared_ptr<Viewer> viewer, std::size_t most);
  /// Gives one of them the latest picture, if it shows `revision`.
  void show_latest(Viewer& viewer, std::uint64_t revision) const;
  void leave(const Viewer& viewer);
  std::size_t size() const;

  /// Whether someone watches who has fewer pictures on the way, with `in_the_making` that all will get, than may be.
  bool wants_picture(int in_the_making) const;

  /// The link that pictures are made for: the driver's, or of whoever came first. What others cannot take they skip.
  LinkPace pace() const;

  /// As what the next picture is to be made for those who see this audience.
  PictureNeed need() const;
  /// Video makes trouble: everyone has JPEG from here on.
  void demote(const protocol::Problem& problem);

  /// Gives everyone who sees this audience a picture, unless a newer one came before.
  void show(std::shared_ptr<const Picture> picture);
  /// `by`: the viewer whose input `seq` it was, or null.
  void tell_change(unsigned members, const Viewer* by, std::uint32_t seq);
  void report(const protocol::Problem& problem);
  void end(protocol::CloseCode code, const std::string& reason, bool reconnect);
  /// Ends the stream that was given this token, if it is still there.
  void end_resumed(const std::string& resume_token);
  void check_patience(SteadyTime now);

 private:
  std::vector<std::shared_ptr<Viewer>> viewers() const;
  std::vector<std::shared_ptr<Viewer>> spectators() const;
  static const Viewer* leader(const std::vector<std::shared_ptr<Viewer>>& spectators);

  const std::uint64_t source_;

  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<Viewer>> viewers_;
  std::shared_ptr<const Picture> latest_;
};

}  // namespace lightwell
