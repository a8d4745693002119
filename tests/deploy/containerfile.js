// The Containerfile: what it says, and its steps done in a bare Debian, where no container engine is needed.
'use strict';
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const { DEPLOY, output } = require('./helpers.js');

const SOURCE = path.dirname(DEPLOY);
const BASE = 'docker.io/library/debian:bookworm-slim';  // mmdebstrap's minbase has the same packages, and documentation
const PATH = '/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin';

/** The stages: their names, and their instructions as pairs of a name and words. */
function stages() {
  const text = fs.readFileSync(path.join(DEPLOY, 'Containerfile'), 'utf8').replace(/^#.*\n/gm, '').replace(/\\\n\s*/g, '');
  const found = [];
  for (const line of text.trim().split(/\n+/)) {
    const [, instruction, words] = /^([A-Z]+) (.*)$/.exec(line);
    if (instruction === 'FROM') {
      const [, base, name] = /^(\S+)(?: AS (\S+))?$/.exec(words);
      found.push({ base, name, instructions: [] });
    } else {
      found.at(-1).instructions.push([instruction, words]);
    }
  }
  return found;
}

/** What the instructions of a name say in a stage. */
const wordsOf = (stage, name) => stage.instructions.filter(([instruction]) => instruction === name).map(([, words]) => words);

/** The settings of ENV in a stage, or in its first instructions. */
const environmentOf = (stage, count = Infinity) => wordsOf({ instructions: stage.instructions.slice(0, count) }, 'ENV').flatMap((line) => line.split(' ')).map((word) => word.split('='));

/** The files of the checkout that .dockerignore leaves to the engine, by their paths in it. */
function context() {
  const patterns = fs.readFileSync(path.join(SOURCE, '.dockerignore'), 'utf8').split('\n').filter((line) => line && !line.startsWith('#'));
  for (const pattern of patterns) assert.match(pattern, /^(\*\*\/)?[\w.-]+$/, 'of the patterns only these are understood here');
  const isIgnored = (name) => patterns.includes(name) || patterns.includes(`**/${path.basename(name)}`);
  const below = (folder) => fs.readdirSync(path.join(SOURCE, folder), { withFileTypes: true }).flatMap((entry) => {
    const name = path.join(folder, entry.name);
    if (isIgnored(name)) return [];
    return entry.isDirectory() ? below(name) : [name];
  });
  return below('');
}

/** Packs a file of the context, or all of it ('.'). */
function packContext(source, archive) {
  const top = path.join(SOURCE, path.dirname(source));
  const files = context().filter((name) => source === '.' || name === source).map((name) => path.relative(top, path.join(SOURCE, name)));
  assert.ok(files.length > 0, `there is no ${source}`);
  output('tar', ['--create', '--file', archive, '--owner=0', '--group=0', '--directory', top, '--verbatim-files-from', '--files-from=-'], { input: files.join('\n') });
}

const quoted = (word) => `'${word.replaceAll("'", "'\\''")}'`;

/**
 * Does the steps of the Containerfile.
 * @param {string} folder for archives in between
 * @returns {string} a tar archive of the last stage's root
 */
function makeRoot(folder) {
  const all = stages();
  for (const [number, stage] of all.entries()) {
    assert.equal(stage.base, BASE);
    const isLast = number === all.length - 1;
    const hooks = [];
    const hook = (command) => hooks.push(`--customize-hook=${command}`);
    let directory = '/';
    stage.instructions.forEach(([instruction, words], step) => {
      if (instruction === 'WORKDIR') {
        directory = path.posix.join(directory, words);
        hook(`mkdir -p "$1"${quoted(directory)}`);
      } else if (instruction === 'COPY') {
        const [, from, source, target] = /^(?:--from=(\S+) )?(\S+) (\S+)$/.exec(words);
        assert.match(target, /^\.$|\/$/, 'a folder');
        const to = path.posix.resolve(directory, target);
        hook(`mkdir -p "$1"${quoted(to)}`);
        if (from) {
          hook(`sync-in ${path.join(folder, from)} ${to}`);
        } else {
          const archive = path.join(folder, `${number}-${step}.tar`);
          packContext(source, archive);
          hook(`tar-in ${archive} ${to}`);
        }
      } else if (instruction === 'RUN') {
        const settings = environmentOf(stage, step).map(([name, value]) => quoted(`${name}=${value}`)).join(' ');
        hook(`env -i PATH=${PATH} ${settings} chroot "$1" /bin/sh -c ${quoted(`cd ${directory} && ${words}`)}`);
      }
    });
    for (const [instruction, words] of all.slice(number + 1).flatMap(({ instructions }) => instructions)) {
      const source = instruction === 'COPY' && new RegExp(`^--from=${stage.name} (\\S+) `).exec(words)?.[1];
      if (source) hook(`sync-out ${source} ${path.join(folder, stage.name)}`);
    }
    output('mmdebstrap', ['--variant=minbase', ...hooks, `--format=${isLast ? 'tar' : 'null'}`, 'bookworm', isLast ? path.join(folder, 'root.tar') : '/dev/null'],
      { maxBuffer: 1 << 28 });
  }
  return path.join(folder, 'root.tar');
}

module.exports = { BASE, context, environmentOf, makeRoot, stages, wordsOf };
