// What the handlers of routes work with.
#pragma once

#include <atomic>

#include "server/http/route_table.h"
#include "server/operations/metrics.h"
#include "server/render/render_loop.h"
#include "server/scenes/scene_store.h"
#include "server/sequences/sequence_store.h"
#include "server/session/session_store.h"
#include "server/worker_pool.h"

namespace lightwell {

struct Services {
  const ServeOptions& options;
  SceneStore& scenes;
  SessionStore& sessions;
  RenderLoop& render_loop;
  WorkerPool& encoders;
  const SessionSurroundings& surroundings;
  const std::atomic<bool>& leaving;
  Metrics& metrics;
  SequenceStore* sequences;           // null: there is no folder for them
  std::function<Levels()> levels;     // as they stand now
  std::atomic<int>& renders_waiting;  // requests for pictures that wait for the render thread
  WorkerPool& long_workers;           // for what takes its time
  std::atomic<int>& films;            // being made
};

// Each adds its routes; `services` outlives the table.
void add_health_routes(http::RouteTable& table, const Services& services);
void add_scene_routes(http::RouteTable& table, const Services& services);
void add_session_routes(http::RouteTable& table, const Services& services);
void add_metrics_routes(http::RouteTable& table, const Services& services);
void add_sequence_routes(http::RouteTable& table, const Services& services);
void add_render_routes(http::RouteTable& table, const Services& services);
/// The viewer's files: from the binary, or from a folder as they are at each request.
void add_viewer_routes(http::RouteTable& table, const std::string& folder);

}  // namespace lightwell
