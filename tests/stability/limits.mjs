// The table of limits in LIMITS.md, from what the studies gave.
//
//   node tests/stability/limits.mjs [RESULTS...]
//
// RESULTS, written by the program `stability`, replace those that are kept in data/, study by study; then the table in
// LIMITS.md is written anew. Nothing is written where a study failed.
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = path.join(path.dirname(fileURLToPath(import.meta.url)), '../..');
const kept = path.join(root, 'tests/stability/data/results.json');
export const PAGE = path.join(root, 'tests/stability/LIMITS.md');
const BEGIN = '<!-- Written by tests/stability/limits.mjs. -->\n';
const END = '<!-- End of the table of limits. -->\n';

/**
 * Of each row: `what` is pushed; how far it `holds`, by what each of its `studies` gave (see held); and what happens
 * `beyond`, where that is not in a study by a test of `tests`, as [file, name].
 */
export const ROWS = [
  {
    what: 'position and depth of a scene',
    studies: ['positions', 'depth'],
    tests: [['tests/protocol/state_test.cpp', 'each member of the state: types and ranges']],
    holds: (positions, depth) =>
      `${power(positions.to)} times its size from the origin ${off(positions)}; with far / near up to ${power(depth.to)}, surfaces ${power(depth.bound)} of their distance apart keep their order`,
    beyond: 'positions beyond ±10³⁰ are rejected',
  },
  {
    what: 'camera',
    studies: ['moves', 'zoom', 'numbers'],
    holds: (moves, zoom) =>
      `after ${power(moves.to)} turns its distance from the centre is off by ${short(moves.worst)} of itself; ${power(zoom.to)} wheel steps at once end before the focus`,
    beyond: 'a move whose result is not finite is not made',
  },
  {
    what: 'the camera of walls',
    studies: ['walls-lag', 'walls-catch-up'],
    tests: [['tests/navigation/comfort_limiter_test.cpp', 'it jumps where the way is longer than ten seconds at full speed, and where steps are too fine']],
    holds: (lag, flicks) =>
      `after flicks of half a second up to ${short(flicks.to)} degrees a second, walls that turn by at most 45 are where the camera is within ${seconds(1000 * flicks.worst)}`,
    beyond: 'where the eye is farther than walls go in 10 s, they jump',
  },
  {
    what: 'flat mirrors',
    studies: ['mirrors', 'bent-mirrors'],
    holds: (mirrors) => `${short(mirrors.to)} in a picture, each flat to 10⁻⁴ of its radius: ${off(mirrors)}`,
    beyond: 'smaller mirrors are drawn as plain surfaces; curved ones reflect the environment map, or are plain, with a notice',
  },
  {
    what: 'mirrors that face each other',
    studies: ['mirrors-in-mirrors'],
    holds: (mirrors) => `reflectivities up to ${short(mirrors.to)} %: against endless reflection ${off(mirrors)}`,
    beyond: 'after one reflection mirrors are plain',
  },
  {
    what: 'glass',
    studies: ['panes', 'rings', 'many-panes', 'close-panes', 'panes-by-id'],
    holds: (panes, rings, many, close) =>
      `${short(panes.to)} panes that cross in one line, rings of ${short(rings.to)}, ${short(many.to)} small panes at all angles: ${off(many)}; panes ${power(1 / close.to)} of their size apart keep their order`,
    beyond: 'of panes closer than 10⁻⁶ of their size the one with the higher id is in front; with more than a million overlapping pairs and more than 64 layers, glass is sorted by distance',
  },
  {
    what: 'sections',
    studies: ['section-edge-on', 'section-at-a-face', 'section-walls', 'section-slivers', 'section-gaps'],
    tests: [['tests/protocol/state_test.cpp', 'there are six planes of sections at most']],
    holds: (edgeOn, face, walls, slivers) =>
      `six planes and a box; the eye ${power(1 / edgeOn.to)} above a plane, in it and below: ${off(edgeOn)}; ${short(walls.to)} walls behind a cap; a part ${power(slivers.to)} times as long as thick`,
    beyond: 'a seventh plane is rejected; a part with a gap is not closed: it shows both sides, and lines where it is cut',
  },
  {
    what: 'features of noisy meshes',
    studies: ['noisy-corners', 'noisy-edges', 'noisy-circles', 'noisy-planes', 'noisy-values', 'noisy-mistakes'],
    holds: (corners, edges, circles, planes, values) =>
      `noise of the vertices up to so much of the length of an edge: corners ${power(corners.to)}, straight edges of several pieces ${power(edges.to)}, circles ${power(circles.to)}, planes of fine meshes ${power(planes.to)}; what is found is off by ${short(values.worst)} times the noise at most`,
    beyond: 'pieces of edges, and points; from 10⁻² on planes that lean by more than a degree',
  },
  {
    what: 'circles and planes of tessellated parts',
    studies: ['coarse-circles', 'coarse-discs', 'short-arcs', 'sliver-planes', 'rounded-slivers'],
    holds: (circles, discs, arcs, slivers, rounded) =>
      `circles of ${short(Math.round(360 / circles.to))} edges on solids and ${short(Math.round(360 / discs.to))} on sheets, and arcs of ${short(Math.round(360 / arcs.to))} degrees, in floats: radius within ${power(arcs.bound)} of itself; a face's sliver ${power(slivers.to)} times as long as wide: normal within ${power(slivers.bound)}; rounded to floats, ${power(rounded.to)} times and ${power(rounded.bound)}`,
    beyond: 'polygons have corners and edges; a thinner sliver in floats has no plane',
  },
  {
    what: 'minified textures',
    studies: ['minified'],
    holds: (minified) => `${short(minified.to)} texels to a pixel: within ${short(minified.worst)} of 255`,
    beyond: '',
  },
  {
    what: 'size of a texture',
    studies: ['odd-textures', 'small-odd-textures'],
    tests: [['tests/io/image_file_test.cpp', 'the size is judged from the header']],
    holds: () => 'any, odd or not, up to 16,384 texels a side, if the driver takes as many',
    beyond: 'a file with more is rejected; what the driver does not take is drawn half as sharp or less',
  },
  {
    what: 'fewer triangles',
    studies: ['outlines', 'popping'],
    holds: (outlines, popping) =>
      `with ${short(outlines.to)} times fewer, an outline moves by at most ${short(outlines.worst)} of the error that is told; where ${short(popping.to)} pixels are allowed, at most ${short(popping.worst)} % of the pixels change by more than 8 of 255 when a level changes`,
    beyond: 'the built-in levels allow no more than 2 pixels; a refined frame has every triangle',
  },
  {
    what: 'thin saturated lines',
    studies: ['thin-lines'],
    holds: (lines) => `down to a width of ${short(1 / lines.to)} pixel in 4:4:4, in refined frames and wherever lines are drawn`,
    beyond: 'in other frames (4:2:0) lines of less than two pixels lose half of their colour',
  },
  {
    what: 'double taps',
    studies: ['jitter'],
    holds: (jitter) => `presses that shake by ${short(jitter.to)} pixels`,
    beyond: 'a press that moves by more than 10 pixels is a drag',
  },
  {
    what: "a client's clock",
    studies: ['clocks'],
    holds: (clocks) => `jumps up to ${power(clocks.to)} ms: the time between two events is off by at most ${seconds(clocks.bound)}`,
    beyond: 'after a jump of more than a second the time of arrival counts',
  },
  {
    what: 'input',
    studies: ['bursts', 'resizes'],
    tests: [['tests/net/deadlines_test.cpp', 'who sends more messages than he was promised is read more slowly, and nothing is lost']],
    holds: (moves, sizes) =>
      `${short(moves.to)} moves or ${short(sizes.to)} resizes a second: a frame shows the last one within ${seconds(Math.max(moves.bound, sizes.bound))}`,
    beyond: 'a client that sends more than 10,000 messages a second is read more slowly, and none is lost',
  },
  {
    what: 'a frame that is warped until the next one comes',
    studies: ['warped-turns', 'warped-looks', 'warped-zooms', 'warped-glass', 'warped-mirrors', 'warped-bars', 'warped-parts'],
    holds: (turns, looks, zooms, glass, mirrors) =>
      `nearer to the truth than as it is, in turns up to ${short(turns.to)} degrees, looks aside up to ${short(looks.to)} degrees, and up to ${short(zooms.to)} times as near; seen through glass or in mirrors, in turns up to ${short(Math.min(glass.to, mirrors.to))} degrees`,
    beyond: 'the page warps turns up to 20 degrees, lags behind beyond, and stops at 35',
  },
  {
    what: 'slow links',
    studies: ['slow-links', 'long-links', 'stalls'],
    tests: [['tests/stability/links_test.cpp', 'frames and patches arrive as young through HAProxy as directly']],
    holds: (slow, long, stalls) =>
      `from ${short(1000 / slow.to)} kbit/s on a frame shows a move of a drag within ${seconds(slow.bound)} and the time of two of the smallest frames, through HAProxy too; at 10 Mbit/s with a delay up to ${seconds(long.to)} each way, within ${seconds(long.bound)} and two round trips; after a stall of up to ${seconds(1000 * stalls.to)} the newest frame comes within ${seconds(stalls.bound)}`,
    beyond: 'the server closes a connection that has taken nothing for 10 s, and the page connects again; after a long rest a refined frame may be in transit before a drag',
  },
];

/** The studies of a results file by their names. */
export function read(file = kept) {
  return new Map(JSON.parse(readFileSync(file, 'utf8')).map((study) => [study.study, study]));
}

/**
 * How far a study's method holds: `to` is the largest parameter, `worst` the largest measure up to there, `bound` what the
 * measure may be. Throws where the method does not hold, or where there is no such study.
 */
export function held(results, name) {
  const study = results.get(name);
  if (!study) throw new Error(`There are no results of a study '${name}'.`);
  if (study.failure) throw new Error(`The study '${name}' failed: ${study.failure}.`);
  const ends = study.points.findIndex(([x, y]) => x >= (study.limit ?? Infinity) || y > study.bound);
  const points = ends < 0 ? study.points : study.points.slice(0, ends);
  if (points.length === 0) throw new Error(`The method of the study '${name}' holds nowhere.`);
  return { to: points.at(-1)[0], worst: Math.max(...points.map(([, y]) => y)), bound: study.bound };
}

export function table(results) {
  const line = ({ what, studies = [], holds, beyond }) =>
    `| ${what} | ${holds(...studies.map((name) => held(results, name)))} | ${beyond} |\n`;
  return `| what | holds | beyond |\n|---|---|---|\n${ROWS.map(line).join('')}`;
}

/** The page's text, with `rows` for its table. */
export function withTable(text, rows) {
  const [begin, end] = [text.indexOf(BEGIN), text.indexOf(END)];
  if (begin < 0 || end < begin) throw new Error('LIMITS.md lacks the marks around its table.');
  return text.slice(0, begin + BEGIN.length) + rows + text.slice(end);
}

/** A study of pictures. */
function off({ worst }) {
  const pixels = worst === 0 ? 'no pixel is' : `at most ${short(worst)} % of the pixels are`;
  return `${pixels} off by more than 8 of 255`;
}

/** A whole number, or two digits that mean something. */
function short(value) {
  if (value > 0 && value < 1e-3) return power(10 ** Math.ceil(Math.log10(value) - 0.1));
  return (Number.isInteger(value) ? value : Number(value.toPrecision(2))).toLocaleString('en');
}

/** As a power of ten, where it is one. */
function power(value) {
  const exponent = Math.log10(value);
  if (Math.abs(exponent) < 3 || Math.abs(exponent - Math.round(exponent)) > 1e-9) return short(value);
  return `10${[...String(Math.round(exponent))].map((digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[digit] ?? '⁻').join('')}`;
}

function seconds(ms) {
  return `${short(ms / 1000)} s`;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const results = process.argv.slice(2).reduce((studies, file) => new Map([...studies, ...read(file)]), read());
  for (const study of results.keys()) held(results, study);
  const text = withTable(readFileSync(PAGE, 'utf8'), table(results));
  writeFileSync(kept, `[\n${[...results.values()].map((study) => JSON.stringify(study)).join(',\n')}\n]\n`);
  writeFileSync(PAGE, text);
}
