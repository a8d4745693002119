// The examples in the pages of protocol/: what stands between ```json WHAT and ```.
import { readFileSync } from 'node:fs';

const FOLDER = new URL('../../../protocol/', import.meta.url);
export const PAGES = ['PROTOCOL', 'CLIENT_MESSAGES', 'SERVER_MESSAGES', 'STATE', 'FRAMES', 'NAVIGATION', 'EVENT_LOG', 'LEVELS', 'CUES'];

/** @returns {Array<{what: string, where: string, value: any}>} of a page, in its order */
export function examplesOf(page) {
  const text = readFileSync(new URL(`${page}.md`, FOLDER), 'utf8');
  return [...text.matchAll(/^```json(.*)\n([^]*?)^```$/gm)].map(({ index, 1: what, 2: json }) => {
    const where = `${page}.md:${text.slice(0, index).split('\n').length}`;
    try {
      return { what: what.trim(), where, value: JSON.parse(json) };
    } catch (error) {
      throw new Error(`${where}: ${error.message}`);
    }
  });
}
