// Decides what a session's viewers see next: pictures while something changes, then a finer and finer one, then rest.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "server/operations/metrics.h"
#include "server/render/subject.h"
#include "server/session/session_state.h"
#include "server/stream/audience.h"
#include "server/stream/frame_encoders.h"
#include "server/stream/picture_grade.h"
#include "server/worker_pool.h"

namespace lightwell {

struct DirectorOptions {
  std::chrono::milliseconds still_before_refining{200};
  std::chrono::microseconds least_frame_time{16'600};   // no more than 60 pictures a second
  std::uint32_t refining_frames = 64;                   // in the final picture
  std::chrono::milliseconds still_before_reference{0};  // then the method reference takes over; 0: never
  std::uint32_t reference_frames = 1024;                // in its final picture
  int quality = 80;                                     // JPEG, while the picture changes
  int final_quality = 95;
  FrameEncoders encode;
};

/// A session, or a viewer's own look at one, as the director sees it.
class DirectedSession {
 public:
  virtual ~DirectedSession() = default;
  virtual std::shared_ptr<const SessionState> state() const = 0;
  virtual Audience& audience() = 0;
  virtual bool ended() const = 0;
  /// A picture was encoded, on whatever thread.
  virtual void picture_encoded(double seconds, const EncodedBytes& bytes) = 0;
  /// A picture could not be, on whatever thread.
  virtual void encoding_failed(PictureCodec codec) = 0;
  /// The render loop should ask again.
  virtual void wake_render_loop() = 0;
};

/// Called by the render thread; hands frames to `encoders`, so that the next is rendered while the last is encoded.
class Director : public Subject, public std::enable_shared_from_this<Director> {
 public:
  /// `encoders` outlives the director.
  Director(std::shared_ptr<DirectedSession> session, WorkerPool& encoders, const DirectorOptions& options);

  SteadyTime due_at(SteadyTime now) override;
  Result<Shot> take_shot(SteadyTime now) override;
  void shot_done(Result<Frame> frame) override;
  bool ended() const override { return session_->ended(); }

 private:
  enum class Kind { kFresh, kRefining };
  struct Take {  // the shot being made
    Kind kind = Kind::kFresh;
    std::shared_ptr<const SessionState> state;
    FrameRequest request;
    PictureGrade grade;
    SteadyTime start{};
    Method method = Method::kThesis;  // that it is made by: the session's or `reference`
    bool shown = true;                // or only added to what the next one shows
    bool is_final = false;
  };

  bool goes_over_into_reference() const;
  std::uint32_t frames_wanted() const;
  Result<Shot> take_fresh_shot();
  std::function<bool()> gives_way_to_inputs() const;
  Shot take_refining_shot();
  PictureGrade choose_grade();
  void encode(Frame frame);
  PictureNeed need_of(const Take& take, const Frame& frame, SteadyTime now) const;
  std::optional<VideoPacket> encode_video(const Take& take, const Frame& frame, bool want_key);
  bool encode_file(const Take& take, const Frame& frame, Picture& picture);
  void show(const Take& take, const Frame& frame, std::uint64_t number);
  void describe(const Take& take, const Frame& frame, Picture& picture) const;

  const std::shared_ptr<DirectedSession> session_;
  WorkerPool& encoders_;
  const DirectorOptions options_;

  Take take_;
  SteadyTime started_{}, last_started_{};       // the last picture that was not given up, and the one before it
  std::uint64_t finished_revision_ = 0;         // of the last picture that was finished
  std::chrono::duration<double> usual_time_{};  // of a fresh picture on the render thread, as the last one took
  std::mutex show_mutex_;                       // pictures become video and are shown in their order
  std::uint64_t shown_number_ = 0;              // of the newest picture shown
  VideoEncoder video_;
  std::atomic<SteadyTime> last_key_at_{};
  std::mutex grader_mutex_;
  PictureGrader grader_;
  SteadyTime still_since_{};       // the last picture that showed a change
  std::uint32_t accumulated_ = 0;  // frames in the picture
  bool in_reference_ = false;      // the picture is made by the method reference, whatever the session's is
  std::atomic<std::uint64_t> failed_revision_ = 0;
  SteadyTime retry_at_{};
  std::uint64_t next_number_ = 1;
  std::atomic<int> in_the_making_ = 0;  // pictures rendered or to be, that viewers have not got yet
};

}  // namespace lightwell
