// The token that a server may ask for: given in the address (#token=...) or by the user, kept for as long as the tab.

const kTokenKey = "lightwell.token";
const kBearerSubprotocol = "bearer.";

export class Access {
  /** @param {Storage} storage where the token is kept */
  constructor(storage) {
    this.storage = storage;
  }

  get token() {
    return this.storage.getItem(kTokenKey) ?? "";
  }

  set token(text) {
    this.storage.setItem(kTokenKey, text.trim());
  }

  /** Takes the token out of an address' hash. @param {string} hash @returns {string} the hash without it */
  take_from(hash) {
    const parts = hash.replace(/^#/, "").split("&").filter((part) => part !== "");
    const given = parts.find((part) => part.startsWith("token="));
    if (given) this.token = decodeURIComponent(given.slice("token=".length));
    const rest = parts.filter((part) => part !== given).join("&");
    return rest ? `#${rest}` : "";
  }

  /** Header fields for a request to the server. */
  headers() {
    return this.token ? { authorization: `Bearer ${this.token}` } : {};
  }

  /** What a WebSocket asks for: browsers let a page set nothing else of the handshake. @param {string} subprotocol */
  subprotocols(subprotocol) {
    return this.token ? [subprotocol, kBearerSubprotocol + this.token] : [subprotocol];
  }
}

/** Asks the user for a token; calls `given` when there is one. @param {Access} access @param {string} reason */
export function ask_for_token(access, reason, given) {
  const dialog = document.getElementById("token-dialog");
  const input = document.getElementById("token-input");
  document.getElementById("token-reason").textContent = reason;
  input.value = "";
  dialog.querySelector("form").onsubmit = () => {
    if (input.value.trim() === "") return;
    access.token = input.value;
    given();
  };
  if (!dialog.open) dialog.showModal();
}
