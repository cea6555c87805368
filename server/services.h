// What the handlers of routes work with.
#pragma once

#include <atomic>

#include "server/http/route_table.h"
#include "server/render/render_loop.h"
#include "server/scenes/scene_store.h"
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
};

// Each adds its routes; `services` outlives the table.
void add_health_routes(http::RouteTable& table, const Services& services);
void add_scene_routes(http::RouteTable& table, const Services& services);
void add_session_routes(http::RouteTable& table, const Services& services);
void add_render_routes(http::RouteTable& table, const Services& services);
/// The viewer's files: from the binary, or from a folder as they are at each request.
void add_viewer_routes(http::RouteTable& table, const std::string& folder);

}  // namespace lightwell
