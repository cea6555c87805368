// Asio and Beast, compiled once for everything that uses them.
#include <utility>

// <utility> before Asio: its 1.74 forgets it.
#include <boost/asio/impl/src.hpp>
#include <boost/asio/ssl/impl/src.hpp>
#include <boost/beast/src.hpp>
