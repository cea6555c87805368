#include "server/net/server.h"

#include <sys/resource.h>

#include <future>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

// <utility> before Asio: its 1.74 forgets it.
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/net/connection.h"

namespace lightwell::net {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr int kBacklog = 1024;
constexpr auto kRetryAccept = std::chrono::milliseconds(100);

/// As many open files as we may have: every connection is one.
void raise_file_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// TLS 1.2 and 1.3 with what OpenSSL takes for good ciphers.
asio::ssl::context tls_context(const ServerOptions& options) {
  asio::ssl::context context(asio::ssl::context::tls_server);
  context.set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_sslv2 |
                      asio::ssl::context::no_sslv3 | asio::ssl::context::no_tlsv1 | asio::ssl::context::no_tlsv1_1 |
                      SSL_OP_NO_RENEGOTIATION);
  error_code error;
  context.use_certificate_chain_file(options.tls_certificate, error);
  if (error) throw std::runtime_error("the TLS certificate " + options.tls_certificate + ": " + error.message());
  context.use_private_key_file(options.tls_key, asio::ssl::context::pem, error);
  if (error) throw std::runtime_error("the TLS key " + options.tls_key + ": " + error.message());
  return context;
}

}  // namespace

struct Server::State {
  explicit State(const ServerOptions& options)
      : shared(std::make_shared<Shared>(options)), strand(asio::make_strand(io)), acceptor(strand), retry(strand) {}

  void listen() {
    const ServerOptions& options = shared->options;
    const std::string where = options.host + ":" + std::to_string(options.port);
    error_code error;
    tcp::resolver resolver(io);
    const auto found = resolver.resolve(options.host, std::to_string(options.port), tcp::resolver::passive, error);
    if (error || found.empty()) throw std::runtime_error("cannot listen on " + where + ": no such address");
    const tcp::endpoint endpoint = found.begin()->endpoint();
    if (options.loopback_only && !endpoint.address().is_loopback())
      throw std::runtime_error("cannot listen on " + where +
                               ": other machines reach this address, and no token is asked for (--tokens FILE)");
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(kBacklog, error);
    if (error) throw std::runtime_error("cannot listen on " + where + ": " + error.message());
    local = acceptor.local_endpoint();
  }

  void accept() {
    acceptor.async_accept(asio::make_strand(io), [this](error_code error, auto socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {  // out of file descriptors, most likely: others must close first
        retry.expires_after(kRetryAccept);
        retry.async_wait([this](error_code stopped) {
          if (!stopped) accept();
        });
        return;
      }
      accepted(std::move(socket));
      accept();
    });
  }

  template <class Socket>
  void accepted(Socket socket) {
    error_code error;
    socket.set_option(tcp::no_delay(true), error);
    const auto remote = socket.remote_endpoint(error);
    if (error) return;  // gone already
    TcpStream stream(std::move(socket));
    if (shared->connections.size() >= shared->options.max_connections)
      return refuse_connection(std::move(stream), shared);
    serve_connection(std::move(stream), Peer{remote.address().to_string(), remote.port()}, shared);
  }

  std::shared_ptr<Shared> shared;
  asio::io_context io;
  asio::executor_work_guard<asio::io_context::executor_type> work{io.get_executor()};
  Strand strand;
  asio::basic_socket_acceptor<tcp, Strand> acceptor;
  asio::basic_waitable_timer<std::chrono::steady_clock, asio::wait_traits<std::chrono::steady_clock>, Strand> retry;
  tcp::endpoint local;
  std::vector<std::thread> threads;
};

Server::Server(const ServerOptions& options) : state_(std::make_unique<State>(options)) {
  raise_file_limit();
  if (!options.tls_certificate.empty()) state_->shared->tls.emplace(tls_context(options));
  state_->listen();
}

Server::~Server() {
  stop();
}

void Server::stop() {
  state_->io.stop();
  for (std::thread& thread : state_->threads) thread.join();
  state_->threads.clear();
  state_->shared->connections.let_go_all();
}

void Server::start(Application& application) {
  state_->shared->application = &application;
  asio::post(state_->strand, [state = state_.get()] { state->accept(); });
  for (int i = 0; i < state_->shared->options.io_threads; ++i)
    state_->threads.emplace_back([state = state_.get()] { state->io.run(); });
}

int Server::port() const {
  return state_->local.port();
}

std::string Server::host_in_url() const {
  const auto address = state_->local.address();
  return address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
}

int Server::connections() const {
  return state_->shared->connections.size();
}

bool Server::drain(std::chrono::milliseconds limit) {
  state_->shared->connections.drain_all();
  const bool all_ended = state_->shared->connections.wait_until_empty(limit);
  std::promise<void> closed;
  asio::post(state_->strand, [state = state_.get(), &closed] {
    error_code ignored;
    state->acceptor.close(ignored);
    state->retry.cancel();
    closed.set_value();
  });
  closed.get_future().wait();
  return all_ended;
}

}  // namespace lightwell::net
