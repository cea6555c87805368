#include "server/running_server.h"

namespace lightwell {

RunningServer::RunningServer(const ServeOptions& options, MakePictureSource make_source, FrameEncoders encode)
    : base_path_(options.base_path),
      tls_(!options.tls_certificate.empty()),
      net_(net_options(options)),
      service_(
          options, std::move(make_source), [this] { return net_.connections(); }, std::move(encode)) {
  net_.start(service_);
}

RunningServer::~RunningServer() {
  net_.stop();      // nobody calls the service any more
  service_.stop();  // nobody answers any more
}

std::string RunningServer::url() const {
  return (tls_ ? "https://" : "http://") + net_.host_in_url() + ":" + std::to_string(net_.port()) + base_path_ + "/";
}

void RunningServer::announce_drain() {
  service_.announce_drain();
}

bool RunningServer::drain(std::chrono::milliseconds limit) {
  service_.drain();
  return net_.drain(limit);
}

net::ServerOptions RunningServer::net_options(const ServeOptions& options) {
  net::ServerOptions result;
  result.host = options.host;
  result.port = options.port;
  result.loopback_only = options.access.tokens.empty();
  result.tls_certificate = options.tls_certificate;
  result.tls_key = options.tls_key;
  result.max_connections = options.limits.max_connections;
  result.max_bodies_bytes = 2 * options.limits.max_upload_bytes + (64u << 20);
  return result;
}

}  // namespace lightwell
