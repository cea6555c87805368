// What all connections of a server have in common. Private to the connection layer: includes Asio.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/strand.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "server/net/server.h"

namespace lightwell::net {

using Strand = boost::asio::strand<boost::asio::io_context::executor_type>;
/// Plain TCP, or TLS over it. Everything that reads and writes is a template over the stream.
using TcpStream = boost::beast::basic_stream<boost::asio::ip::tcp, Strand>;
using TlsStream = boost::beast::ssl_stream<TcpStream>;

/// A number of bytes shared by many takers.
class ByteBudget {
 public:
  explicit ByteBudget(std::uint64_t bytes) : left_(static_cast<std::int64_t>(bytes)) {}
  /// False, and nothing taken, if fewer are left.
  bool take(std::uint64_t bytes);
  void give_back(std::uint64_t bytes) { left_ += static_cast<std::int64_t>(bytes); }

 private:
  std::atomic<std::int64_t> left_;
};

/// Gives bytes of a budget back when it goes.
class BudgetShare {
 public:
  explicit BudgetShare(ByteBudget& budget) : budget_(budget) {}
  ~BudgetShare() { budget_.give_back(taken_); }
  BudgetShare(const BudgetShare&) = delete;
  BudgetShare& operator=(const BudgetShare&) = delete;

  /// Takes what is missing to `bytes` in all; false, and nothing taken, if fewer are left.
  bool grow_to(std::uint64_t bytes);

 private:
  ByteBudget& budget_;
  std::uint64_t taken_ = 0;
};

/// What a connection can be told.
struct ConnectionCalls {
  std::function<void()> drain;   // to end soon; from any thread, at most once
  std::function<void()> let_go;  // of all that is the application's; when no I/O thread runs any more
};

/// The connections that are open, so that they can be told to end and waited for.
class ConnectionSet {
 public:
  /// One that comes while the others are drained is not waited for.
  void add(const void* connection, ConnectionCalls calls);
  void remove(const void* connection);
  /// Those that are waited for.
  int size() const;
  void drain_all();
  /// Also those that are not waited for.
  void let_go_all();
  bool draining() const;
  bool wait_until_empty(std::chrono::milliseconds limit);

 private:
  mutable std::mutex mutex_;
  std::condition_variable emptied_;
  using Calls = std::unordered_map<const void*, ConnectionCalls>;
  Calls open_, late_;
  bool draining_ = false;
};

struct Shared {
  explicit Shared(const ServerOptions& server_options)
      : options(server_options), bodies(server_options.max_bodies_bytes) {}

  Application* application = nullptr;            // set before the first connection
  std::optional<boost::asio::ssl::context> tls;  // set before the first connection, if TLS is spoken
  const ServerOptions options;
  ByteBudget bodies;
  ConnectionSet connections;
};

}  // namespace lightwell::net
