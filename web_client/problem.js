// The server's refusals in words: RFC 9457 problem documents.

/** A refusal. `message` can be shown to a person, `status` is the HTTP status, `retry_after_s` 0 if unnamed. */
export class Problem extends Error {
  constructor(document, status, retry_after_s = 0) {
    super(words_of(document, status));
    this.status = status;
    this.retry_after_s = retry_after_s;
  }
}

/** What a problem document says, as one or two sentences. Anything else gives a sentence about `status`. */
export function words_of(document, status) {
  const title = document?.title ?? "";
  const detail = document?.detail ?? "";
  if (!title && !detail) return `The server answered ${status}.`;
  const place = document.pointer ? ` (at ${document.pointer})` : "";
  const text = detail && title && !detail.includes(title) ? `${title}: ${detail}` : detail || title;
  return `${text.replace(/\.$/, "")}${place}.`;
}

/** The problem in a fetch response that is not ok. @param {Response} response @returns {Promise<Problem>} */
export async function problem_from(response) {
  const document = await response.json().catch(() => null);
  return new Problem(document, response.status, Number(response.headers.get("retry-after")) || 0);
}
