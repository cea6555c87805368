// `lightwell serve`: the server's options.
#pragma once

#include "server/command_line/exit_code.h"
#include "server/serve.h"

namespace CLI {
class App;
}

namespace lightwell {

void add_serve_options(CLI::App& app, ServeOptions& options);

}  // namespace lightwell
