// Who may ask what. The first byte says what the rest is: a file of tokens, or the head of a request to a server with
// tokens, one without, or one that pages from elsewhere may use.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "server/access/access_control.h"

namespace {

using namespace lightwell;

constexpr std::string_view kTokens = "view aaaaaaaaaaaaaaaa\ndrive,upload bbbbbbbbbbbbbbbb\nadmin cccccccccccccccc\n";

void require(bool holds) {
  if (!holds) std::abort();
}

void read_tokens(std::string_view text) {
  const Result<TokenList> list = TokenList::parse(text);
  if (!list) return require(!list.error().what.empty());
  require(!list->empty());
  require(list->find({}).empty());
}

AccessOptions options_of(std::uint8_t kind) {
  AccessOptions options;
  options.requests_per_second = 0.0;
  if (kind % 2 == 1) options.tokens = TokenList::parse(kTokens).value();
  if (kind / 2 % 2 == 1) options.allowed_origins = {"https://example.org"};
  if (kind / 2 % 2 == 1) options.allowed_hosts = {"example.org"};
  return options;
}

void ask(std::uint8_t kind, std::string_view text) {
  const net::HeadScan scan = net::find_head_end(text, 0);
  if (scan.state != net::HeadScan::State::kComplete) return;
  const auto parsed = net::parse_request_head(text.substr(0, scan.head_bytes));
  const auto* head = std::get_if<net::RequestHead>(&parsed);
  if (!head) return;
  AccessControl access(options_of(kind));
  const auto refusal = access.check_origin_and_rate(*head, {"127.0.0.1", 1});
  if (refusal) require((refusal->status == 403 || refusal->status == 421) && !refusal->detail.empty());
  access.is_preflight(*head);
  for (const auto& [name, value] : access.answer_fields(*head))
    require(value.find_first_of("\r\n") == std::string::npos);  // nobody writes fields into our answers
  for (const Scope scope : {Scope::kView, Scope::kDrive, Scope::kUpload, Scope::kAdmin}) {
    const auto scopes = access.check_token(*head, scope);
    if (std::holds_alternative<net::Refusal>(scopes) || !access.has_tokens()) continue;
    const bool brought = text.find("aaaaaaaaaaaaaaaa") != text.npos || text.find("bbbbbbbbbbbbbbbb") != text.npos ||
                         text.find("cccccccccccccccc") != text.npos;
    require(brought && std::get<Scopes>(scopes).has(scope));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  data[0] % 5 == 0 ? read_tokens(text) : ask(static_cast<std::uint8_t>(data[0] % 5 - 1), text);
  return 0;
}
