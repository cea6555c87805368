// The application behind the port: scenes, sessions, the render thread and the routes to them.
#pragma once

#include <future>
#include <memory>
#include <string>

#include "server/net/application.h"
#include "server/render/picture_source.h"
#include "server/serve.h"
#include "server/stream/frame_encoders.h"

namespace lightwell {

/// The scene from the command line was refused: exit code 3.
class SceneRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Service : public net::Application {
 public:
  /// Begins to load the scenes and to warm the renderer up, both in threads of their own.
  /// `connections`: how many are open, for the metrics. Throws std::runtime_error if the data folder cannot be used.
  Service(const ServeOptions& options, MakePictureSource make_source, std::function<int()> connections,
          FrameEncoders encode = {});
  ~Service() override;
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// What pictures are made with, once the first can be had; or the reason why it never will: SceneRefused,
  /// gl::NoDevice, or another exception.
  std::shared_future<SourceFacts> ready() const;

  /// Not ready from here on, but served as before.
  void announce_drain();
  /// Not ready, and nothing but health is served, from here on; all streams are told to reconnect elsewhere and closed.
  void drain();
  /// Ends the render thread and the workers. The connection layer must have stopped calling.
  void stop();

  // net::Application
  net::Admission admit(const net::RequestHead& head, const net::Peer& peer) override;
  void answer(net::Request request, std::function<void(net::Answer)> done) override;
  std::string refusal_response(const net::Refusal& refusal, bool keep_alive, const net::RequestHead* head) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightwell
