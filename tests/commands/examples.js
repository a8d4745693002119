// The examples of the program's help, to be run as they stand there.
'use strict';
const { spawnSync } = require('node:child_process');

const PROGRAM = process.env.VRUT_PREVIEW;

/** What --help prints, of the program or of one command. */
function help(...command) {
  const { status, stdout, stderr } = spawnSync(PROGRAM, [...command, '--help'], { encoding: 'utf8' });
  if (status !== 0) throw new Error(stderr);
  return stdout;
}

/** The part of a help text below a title. */
const section = (text, title) => new RegExp(`^${title}:\\n((?:  .*\\n)+)`, 'm').exec(text)?.[1] ?? '';

/** The names at the left of a part: options, commands, statuses. */
const terms = (part) => [...part.matchAll(/^ {2}(\S.*?)(?: {2,}.*)?$/gm)].map(([, term]) => term);

const commands = () => terms(section(help(), 'Commands'));
const examples = (...command) => terms(section(help(...command), 'Examples'));

module.exports = { PROGRAM, commands, examples, help, section, terms };
