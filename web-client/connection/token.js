import { tokenFrom } from './connection.js';
import { recall, remember } from '../base/memory.js';

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
