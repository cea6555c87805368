// The real server as a child of the test, and a line to it that the test can cut.
import { spawn } from "node:child_process";
import { once } from "node:events";
import net from "node:net";

const kStartWithinMs = 60000;

/** A TCP port that is free now. */
export async function free_port() {
  const probe = net.createServer().listen(0, "127.0.0.1");
  await once(probe, "listening");
  const { port } = probe.address();
  probe.close();
  await once(probe, "close");
  return port;
}

/**
 * A server under way. `kill` ends it without a word to anybody.
 * @typedef {{port: number, log: () => string, stop: () => Promise<void>, kill: () => Promise<void>}} ServerProcess
 */

/**
 * Starts `lightwell serve` and waits until it is ready to render.
 * @param {string} program @param {string[]} options @returns {Promise<ServerProcess>}
 */
export async function start_server(program, options = []) {
  const port = await free_port();
  const child = spawn(program, ["serve", "--port", String(port), ...options], { stdio: ["ignore", "pipe", "pipe"] });
  let log = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (data) => (log += data));
  const stopped = once(child, "exit");
  const until_ms = Date.now() + kStartWithinMs;
  for (;;) {
    const response = await fetch(`http://127.0.0.1:${port}/readyz`).catch(() => null);
    if (response?.ok) break;
    if (child.exitCode !== null || Date.now() > until_ms) {
      child.kill("SIGKILL");
      throw new Error(`the server did not become ready (exit code ${child.exitCode}):\n${log}`);
    }
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  return {
    port,
    log: () => log,
    async stop() {
      child.kill("SIGTERM");
      const timer = setTimeout(() => child.kill("SIGKILL"), 10000);
      await stopped;
      clearTimeout(timer);
    },
    async kill() {
      child.kill("SIGKILL");
      await stopped;
    },
  };
}

/** A TCP line to `target_port` on a port of its own, which can be cut and mended. */
export class Line {
  constructor(target_port) {
    this.target_port = target_port;
    this.sockets = new Set();
    this.is_cut = false;
    this.server = net.createServer((near) => {
      if (this.is_cut) return near.destroy();
      const far = net.connect(this.target_port, "127.0.0.1");
      for (const [from, to] of [[near, far], [far, near]]) {
        this.sockets.add(from);
        from.setNoDelay(true);
        from.pipe(to);
        from.on("error", () => to.destroy());
        from.on("close", () => {
          this.sockets.delete(from);
          to.destroy();
        });
      }
    });
  }

  async open() {
    this.server.listen(0, "127.0.0.1");
    await once(this.server, "listening");
    this.port = this.server.address().port;
    return this;
  }

  /** Ends every connection and refuses new ones. */
  cut() {
    this.is_cut = true;
    this.sockets.forEach((socket) => socket.destroy());
  }

  mend() {
    this.is_cut = false;
  }

  close() {
    this.cut();
    this.server.close();
  }
}
