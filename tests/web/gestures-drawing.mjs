// The drawing of the gestures in the presenter's guide, from what the page's help shows. Run it after a change of that:
// node tests/web/gestures-drawing.mjs
import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { gestures } from '../../web-client/panels/dialogs/help.js';

const PAGE = new URL('../../web-client/', import.meta.url);
export const DRAWING = new URL('guide/gestures.svg', PAGE);

const ROW = 56;
const TITLES = 24;
/** Fingers or a button of the page, the mouse, keys. */
const COLUMNS = [200, 460, 720];
const WIDTH = 900;
/** It lies on a ground of its own, to be read on dark pages, too. */
const STYLE = `
  text { font: 15px system-ui, sans-serif; fill: #16211d; }
  .title { font-weight: 600; }
  .picture { fill: none; stroke: #0e5a46; stroke-width: 2; stroke-linecap: round; stroke-linejoin: round; }
  .picture .pressed { fill: #0e5a46; stroke: none; }
  .picture .wheel { stroke-width: 4; }
  .picture text { font-size: 12px; font-weight: 600; fill: #0e5a46; stroke: none; }
`;

/** @returns {string} SVG */
export function gesturesDrawing() {
  const all = gestures();
  const rows = all.map(({ title, ways }, i) =>
    `  <g transform="translate(0 ${i * ROW})">\n    <text class="title" x="${TITLES}" y="34">${title}</text>\n${ways.map(drawn).join('')}  </g>\n`);
  const height = all.length * ROW;
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${height}" role="img" aria-label="Gestures">
  <!-- Written by tests/web/gestures-drawing.mjs. -->
  <style>${STYLE}  </style>
  <rect width="${WIDTH}" height="${height}" rx="12" fill="#f4f7f5"/>
${rows.join('')}</svg>
`;
}

function drawn({ words, picture, icon, keys }, column) {
  if (keys) return keyCaps(keys);
  const graphic = icon
    ? `<g transform="translate(20 4) scale(1.33)">${iconOf(icon)}</g>`
    : picture;
  return `    <g transform="translate(${COLUMNS[column]} 8)"><g class="picture">${graphic}</g><text x="74" y="26">${words}</text></g>\n`;
}

function keyCaps(keys) {
  let x = COLUMNS[2];
  return keys.map((key) => {
    const width = 18 + 9 * key.length;
    const cap = `    <rect x="${x}" y="14" width="${width}" height="28" rx="5" fill="#fff" stroke="#9db3aa"/>`
      + `<text x="${x + width / 2}" y="33" text-anchor="middle">${key}</text>\n`;
    x += width + 8;
    return cap;
  }).join('');
}

function iconOf(name) {
  return new RegExp(`<path id="icon-${name}" (d="[^"]+")/>`).exec(readFileSync(new URL('index.html', PAGE), 'utf8'))
    .slice(1).map((path) => `<path ${path}/>`)[0];
}

if (process.argv[1] === fileURLToPath(import.meta.url)) writeFileSync(DRAWING, gesturesDrawing());
