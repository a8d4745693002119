import { recall, remember, resumeKey } from '../base/memory.js';
import { roleFrom, tokenFrom } from './connection.js';

/** What the page says of itself. */
export function hello(hash, token) {
  return {
    role: roleFrom(hash),
    // An iPad says that it is a Mac.
    name: /iPhone|Android|Windows|Mac|Linux(?!; A)/.exec(navigator.userAgent)?.[0]
      .replace('Mac', navigator.maxTouchPoints > 1 ? 'iPad' : 'Mac'),
    token,
    resume: resumeKey(),
  };
}

/** The token to say hello with: the address's, or, as an installed page has none there, the last accepted. */
export class Token {
  constructor(hash) {
    const token = tokenFrom(hash);
    this.inAddress = token !== undefined;
    this.value = token ?? recall('token') ?? undefined;
  }

  accepted() {
    if (this.inAddress) remember('token', this.value);
  }
}
