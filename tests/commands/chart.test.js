// Charts from the command line: what is written, what is measured again, and what is refused before measuring.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { after, test } = require('node:test');
const { PROGRAM, examples } = require('./examples.js');

const SCENE = path.join(process.env.VRUT_SCENES, 'teaching', 'glass-crossing.vrut');
const DATA = path.join(__dirname, '..', 'data');
const SESSION = path.join(DATA, 'logs', 'orbit.jsonl'), ROOM = path.join(DATA, 'scenes', 'room.vrut');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vrut-chart-'));
after(() => fs.rmSync(folder, { recursive: true }));

const out = path.join(folder, 'it\'s "out" $(x)');
const SMALL = ['--size', '64x48', '--frames', '1', '--triangles', '20000'];
const environment = { ...process.env, XDG_STATE_HOME: path.join(folder, 'state') };
const run = (options, env = environment) => spawnSync(PROGRAM, ['chart', ...options], { encoding: 'utf8', env });
const measurements = () => fs.readFileSync(path.join(out, 'measurements.csv'), 'utf8').trim().split('\n');

function fails(status, culprit, options, env) {
  const result = run(options, env);
  assert.equal(result.status, status, result.stderr);
  assert.match(result.stderr, culprit);
  assert.equal(result.stderr.trim().split('\n').length, 1, result.stderr);
}

/** Fails where an element is not closed, or closed where it was not opened. */
function checkNesting(svg) {
  const open = [];
  for (const [, end, name, alone] of svg.matchAll(/<(\/?)([a-zA-Z]+)(?:[^<>"']|"[^"]*"|'[^']*')*?(\/?)>/g)) {
    if (end) assert.equal(open.pop(), name);
    else if (!alone) open.push(name);
  }
  assert.deepEqual(open, []);
}

test('the error at the glass in a session', () => {
  const glass = path.join(folder, 'glass');
  const session = ['--glass', SESSION, ROOM, '--size', '96x60', '--every', '6'];
  const lines = ({ status, stdout, stderr }) => {
    assert.equal(status, 0, stderr);
    return stdout.trim().split('\n').map((line) => line.split(/ {2,}/));
  };
  const first = lines(run([...session, '--link', '100,2', '--link', '20,20,5', '--out', glass]));
  assert.deepEqual(first[0].slice(0, 4), ['session', 'link', 'prediction', 'mean']);
  assert.deepEqual(first.slice(1).map(([, link, prediction]) => `${link} ${prediction}`),
    ['100,2', '20,20,5'].flatMap((link) => ['none', 'shift and scale', 'warp', 'no delay'].map((prediction) => `${link} ${prediction}`)));
  const mean = (rows, link, prediction) => Number(rows.find((row) => row[1] === link && row[2] === prediction)[3]);
  for (const link of ['100,2', '20,20,5']) {
    assert.ok(mean(first, link, 'warp') < mean(first, link, 'none'), link);
    assert.ok(mean(first, link, 'no delay') < mean(first, link, 'warp'), link);
  }
  assert.ok(mean(first, '20,20,5', 'none') < mean(first, '100,2', 'none'));
  const again = lines(run([...session, '--link', '20,20,5']));
  assert.deepEqual(again.slice(1), first.slice(5), 'the same numbers again, whatever other links there are');

  const rows = fs.readFileSync(path.join(glass, 'glass.csv'), 'utf8').trim().split('\n');
  assert.equal(rows[0], 'session,link,prediction,mean,p95,longest_ms,frames,bytes,depth_bytes');
  assert.equal(rows.length, 9);
  for (const name of ['glass-links', 'glass-orbit-100-2', 'glass-orbit-20-20-5']) {
    const svg = fs.readFileSync(path.join(glass, `${name}.svg`), 'utf8');
    checkNesting(svg.replace(/<\?xml.*?\?>/, ''));
    // Each line has points at more than a few heights: they lie within the axes.
    const lines = [...svg.matchAll(/<path stroke='[^']+'\s+d='M([^']+)'/g)].map(([, points]) => new Set([...points.matchAll(/,([\d.]+)/g)].map(([, y]) => y)));
    assert.ok(lines.filter((heights) => heights.size > (name === 'glass-links' ? 1 : 4)).length >= 3, name);
  }

  fails(2, /--link: expected the round trip in ms .*found '100'/, [...session, '--link', '100']);
  fails(2, /--link requires --glass/, [SCENE, '--out', out, '--link', '100,2']);
  const long = path.join(folder, 'long.jsonl');
  fs.writeFileSync(long, fs.readFileSync(SESSION, 'utf8').replace(/\{"at":[\d.]+(?=[^\n]*\n$)/, '{"at":4e6'));
  fails(1, /long\.jsonl: the session is longer than an hour: cut its log/, ['--glass', long, ROOM]);
  fails(1, /nothing\.jsonl: it cannot be opened/, ['--glass', path.join(folder, 'nothing.jsonl')]);
  fails(1, /orbit\.jsonl: the scene 'room\.vrut' is not found/, ['--glass', SESSION]);
  fails(2, /--glass: expected one scene, found 2/, ['--glass', SESSION, ROOM, SCENE]);
  fails(2, /--frames excludes --glass|--glass excludes --frames/, [...session, '--frames', '2']);
});

test('charts of a scene, and nothing is measured twice', () => {
  const first = run([SCENE, '--out', out, ...SMALL]);
  assert.equal(first.status, 0, first.stderr);
  assert.match(first.stderr, /\d+ % glass-crossing, stylized/);
  const rows = measurements();
  assert.match(rows[0], /^chart,scene,sha256,renderer,.*,ms_median,.*,bytes_p95,flip_mean,.*,maximum,wrong$/);
  for (const chart of ['modes', 'table-7-1', 'antialiasing', 'lighting', 'transparency', 'jpeg', 'sections', 'pixels', 'picking', 'triangles'])
    assert.ok(rows.some((row) => row.startsWith(`${chart},`)), chart);
  // Its panes have no coarser surfaces.
  assert.ok(!rows.some((row) => row.startsWith('detail,')));

  const files = fs.readdirSync(out);
  const svgs = files.filter((name) => name.endsWith('.svg'));
  for (const name of ['realistic-time', 'stylized-wireframe-bytes-maximum', 'picking', 'transparency', 'lighting', 'jpeg'])
    assert.ok(svgs.includes(`glass-crossing-${name}.svg`), name);
  for (const name of svgs) checkNesting(fs.readFileSync(path.join(out, name), 'utf8').replace(/<\?xml.*?\?>/, ''));

  const page = fs.readFileSync(path.join(out, 'index.html'), 'utf8');
  assert.equal(page.split('<svg').length - 1, svgs.length);
  assert.doesNotMatch(page, /https?:|<script|<link|src=/);
  assert.match(page, /Drawn by .* on .*threads/);

  const second = run([SCENE, '--out', out, ...SMALL]);
  assert.equal(second.status, 0, second.stderr);
  assert.doesNotMatch(second.stderr, /realistic|stylized|picking|triangles every|triangles detail/);
  assert.deepEqual(measurements(), rows);
});

test('the levels of a scene are measured and kept', () => {
  const result = run(['--calibrate', SCENE, '--size', '160x120']);
  assert.equal(result.status, 0, result.stderr);
  const [head, ...levels] = result.stdout.trim().split('\n');
  assert.match(head, /160 x 120/);
  assert.ok(levels.length >= 2 && levels.length <= 9);
  for (const level of levels) assert.match(level, /^scale .* ms .* kB  FLIP \d.*\.$/);
  assert.match(levels.at(-1), /^scale 1, 16 samples, JPEG 90 4:4:4 .*At rest/);
  assert.equal(new Set(levels.map((level) => level.indexOf('  FLIP'))).size, 1, result.stdout);
  assert.equal(fs.readdirSync(path.join(environment.XDG_STATE_HOME, 'vrut-preview', 'levels')).length, 1);
});

for (const example of examples('chart')) {
  test(`example: ${example}`, () => {
    const work = fs.mkdtempSync(path.join(folder, 'example-'));
    fs.symlinkSync(PROGRAM, path.join(work, 'vrut-preview'));
    for (const [file, name] of [[SCENE, 'my.vrut'], [ROOM, 'room.vrut'], [SESSION, 'session.jsonl']]) fs.copyFileSync(file, path.join(work, name));
    // As the example, but for how much it measures.
    const shorter = `${example.replace(/ --(size|frames) \S+/g, '')} ${example.includes('--out') ? SMALL.join(' ') : '--size 64x48'}${example.includes('--glass') ? ' --every 20' : ''}`;
    const env = { ...environment, PATH: `${work}:${process.env.PATH}` };
    const result = spawnSync('bash', ['-c', shorter], { encoding: 'utf8', cwd: work, env });
    assert.equal(result.status, 0, result.stderr);
    if (example.includes('--out charts')) assert.ok(fs.existsSync(path.join(work, 'charts/index.html')));
  });
}

test('what cannot be done is told before anything is measured', () => {
  fails(2, /--out/, [SCENE]);
  fails(2, /--calibrate/, ['--calibrate', SCENE, SCENE]);
  fails(2, /--frames/, [SCENE, '--out', out, '--frames', '0']);
  fails(1, /no-scene\.vrut/, [path.join(folder, 'no-scene.vrut'), '--out', path.join(folder, 'none')]);
  assert.equal(fs.existsSync(path.join(folder, 'none')), false);
  fails(1, /--size.* pixels a side/, [SCENE, '--out', path.join(folder, 'none'), '--size', '8193x100']);
  fails(1, /--size.* pixels a side/, ['--calibrate', SCENE, '--size', '100x8193']);
  assert.equal(fs.existsSync(path.join(folder, 'none')), false);
  const twice = run([SCENE, SCENE, '--out', path.join(folder, 'twice'), ...SMALL]);
  assert.equal(twice.status, 1, twice.stderr);
  assert.match(twice.stderr, /name it once/);
  fs.writeFileSync(path.join(folder, 'file'), '');
  fails(1, /file/, [SCENE, '--out', path.join(folder, 'file', 'x')]);
  fails(1, /gnuplot.*install/, [SCENE, '--out', path.join(folder, 'none')], { ...environment, PATH: folder });
});
