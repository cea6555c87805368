// What a sequence's request means on this server: each frame as something to render.
#pragma once

#include <memory>
#include <string>

#include "protocol/sequence.h"
#include "server/render/subject.h"
#include "server/scenes/staged_scene.h"
#include "server/serve.h"

namespace lightwell {

/// Immutable, thread-safe.
class SequencePlan {
 public:
  /// `request` on `stage`, the scene it names. Whatever any frame could be refused for, as far as it shows in the first
  /// and the last one and at the keys, is a problem (422) here, with the pointer of the member.
  static protocol::Decoded<std::shared_ptr<const SequencePlan>> make(const protocol::SequenceRequest& request,
                                                                     std::shared_ptr<const StagedScene> stage,
                                                                     const ServeOptions& options);

  /// With all settings given.
  const protocol::SequenceRequest& request() const { return request_; }
  std::size_t views() const { return settings_.size(); }

  /// One view of one frame.
  protocol::Decoded<Shot> shot(std::uint32_t frame, std::size_t view) const;

 private:
  SequencePlan() = default;
  std::optional<protocol::Problem> read_settings(const ServeOptions& options);
  std::optional<protocol::Problem> check_frames() const;
  std::optional<protocol::Problem> check_keyframes() const;
  protocol::Decoded<std::shared_ptr<const StagedScene>> stage_at(double time_s) const;

  protocol::SequenceRequest request_;
  ServeLimits limits_;
  std::shared_ptr<const StagedScene> stage_;  // with the request's edits
  std::vector<Settings> settings_;            // one for each view
};

}  // namespace lightwell
