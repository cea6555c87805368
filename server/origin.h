// Which web pages may talk to this server: those it served itself, and those on a list.
#pragma once

#include <string>
#include <vector>

#include "server/net/request_head.h"

namespace lightwell {

/// True without an Origin field (no browser sent it, or it is a plain visit), if the origin's host and port are those
/// of the Host field, or if it is on the list. Reading methods other than streams need no leave: browsers keep the
/// answer from foreign pages by themselves.
bool origin_allowed(const net::RequestHead& head, const std::vector<std::string>& allowed);

}  // namespace lightwell
