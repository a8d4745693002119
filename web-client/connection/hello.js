import { resumeKey } from '../base/memory.js';
import { roleFrom } from './connection.js';

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
