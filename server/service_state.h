// What a service is made of. Private to it.
#pragma once

#include <condition_variable>
#include <thread>

#include "server/http/router.h"
#include "server/sequences/sequence_workers.h"
#include "server/service.h"
#include "server/services.h"
#include "server/session/session_keeper.h"

namespace lightwell {

struct Service::State {
  State(const ServeOptions& serve_options, MakePictureSource make_source, FrameEncoders encode_frames,
        std::function<int()> open_connections);

  void load_scenes();
  /// What pictures can be sent as, the one that every client takes first.
  std::vector<std::string> codecs() const;
  Shot warm_up_shot();
  void direct(std::shared_ptr<DirectedSession> session, std::shared_ptr<RenderAccount> account);
  void keep_house();
  Levels levels();
  void count(const net::RequestHead* head, int status, double seconds);
  std::variant<Scopes, net::Refusal> check_access(const net::RequestHead& below,
                                                  const std::optional<std::string>& session_id);
  net::Admission admit_stream(const net::RequestHead& head, const std::string& session_id, Scopes scopes);
  std::optional<net::Refusal> check_state(std::string_view path) const;
  /// The path without the base path; none if a proxy's user must be sent to the base path's "/".
  std::optional<std::string> path_below_base(const std::string& path) const;

  const ServeOptions options;
  AccessControl access;
  const FrameEncoders encode;
  const std::function<int()> connections;
  Metrics metrics;
  SceneStore scenes;
  std::unique_ptr<SceneFiles> scene_files;  // with what is below null if there is no data folder
  std::unique_ptr<SequenceStore> sequences;
  std::unique_ptr<SessionKeeper> session_keeper;
  SessionStore sessions;
  SessionSurroundings surroundings;
  std::atomic<bool> leaving = false;              // not ready any more
  std::atomic<bool> draining = false;             // and nothing more is begun
  std::promise<std::string> first_scene_promise;  // its name, or SceneRefused
  std::shared_future<std::string> first_scene = first_scene_promise.get_future().share();
  std::atomic<bool> scenes_loaded = false;

  RenderLoop render_loop;
  std::unique_ptr<SequenceWorkers> sequence_workers;
  std::atomic<int> renders_waiting = 0;
  std::atomic<int> films = 0;
  std::unique_ptr<WorkerPool> encoders, quick_workers, long_workers;
  http::RouteTable routes;
  std::unique_ptr<Services> services;
  std::unique_ptr<http::Router> router;

  std::mutex mutex;
  std::condition_variable stopped;
  bool stopping = false;
  std::thread loader, housekeeper;
};

/// Come again in a second.
net::Refusal busy(std::string detail);

}  // namespace lightwell
