// The program's sentences, as the source has them: errors, notices, and the events of the log. They stand together in
// sentences.txt, so that they can be read as one text; `VRUT_RENEW=1 node --test sentences.test.js` writes it anew.
'use strict';
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const { test } = require('node:test');

const SOURCE = path.join(__dirname, '../..');
const LIST = path.join(__dirname, 'sentences.txt');
const HEAD = `The sentences of the program, as its source has them; {} stands for a value. In brackets: the code of an error or of a
notice, or "log" before the name of an event. Written by sentences.test.js.
`;
// What these print is no such sentence: help, charts, names of settings, fields of HTTP, the schema, the usage of an example, words of comments.
const LEFT_OUT = /^(server\/commands\/(command_line|completion|manual)|server\/measure\/(calibrate|charts|experiments|page|plot|rows|settings|time_charts)|server\/observe\/metrics|server\/net\/(http|page)_response|render\/io\/assimp\/up_axis_guess|protocol\/(\w+_descriptions|json_schema|client\/example_host))\.[ch]pp$/;

/** The strings, names and signs of C++ source, without comments and what the preprocessor reads. */
function tokens(source) {
  const pattern = /\/\/[^\n]*|\/\*[^]*?\*\/|^[ \t]*#(?:[^\n\\]|\\[^])*|R"(\w*)\(([^]*?)\)\1"|"((?:[^"\\\n]|\\.)*)"|'(?:[^'\\\n]|\\.)+'|[A-Za-z_]\w*|\d[\w.']*|::|->|\S/gm;
  return [...source.matchAll(pattern)].filter(([text]) => !/^(\/\/|\/\*|\s*#)/.test(text)).map(([text, , raw, plain]) =>
    ({ text, string: raw ?? plain?.replace(/\\n/g, '\n').replace(/\\(.)/g, '$1') }));
}

/** Where the operand of a + ends: at the next sign of its own depth that ends an expression. */
function endOfOperand(list, from) {
  let depth = 0;
  for (let at = from; at < list.length; ++at) {
    const { text, string } = list[at];
    if (string !== undefined) continue;
    if (depth === 0 && /^[-+,;)}\]:?<]$/.test(text) && !(text === '<' && list[at - 1]?.text.endsWith('_cast'))) return at;
    if (/^[([{]$/.test(text)) ++depth;
    if (/^[)\]}]$/.test(text)) --depth;
  }
  return list.length;
}

/** Strings and what is added to them: of `"a" + x + "b"` it is "a{}b". */
function texts(list) {
  const found = [];
  for (let at = 0; at < list.length; ++at) {
    if (list[at].string === undefined) continue;
    const start = at;
    let text = list[at - 1]?.text === '+' ? '{}' : '';
    while (at < list.length) {
      if (list[at].string !== undefined) text += list[at++].string;
      else {
        at = endOfOperand(list, at);
        text += '{}';
      }
      if (list[at]?.string !== undefined) continue;
      if (list[at]?.text === ')' && list[start - 2]?.text === 'string') ++at;  // std::string("a") + x
      if (list[at]?.text !== '+') break;
      ++at;
    }
    found.push({ text, start });
  }
  return found;
}

/** The code beside a text, "error bad-message", or its event in the log. */
function codeOf(list, start) {
  for (let at = start - 1; at > Math.max(0, start - 40) && list[at].text !== ';'; --at) {
    const kind = list[at - 2]?.text;
    if (list[at - 1]?.text === '::' && /^(notice_code|error_code|code)$/.test(kind))
      return `${kind === 'notice_code' ? 'notice' : 'error'} ${list[at].text.replace(/_/g, '-')}`;
  }
  return undefined;
}

const isProse = (text) => /[a-z]{2,},? [a-z]{2,}|: [a-z]/i.test(text) && !/[<>;{]\n|^\s*[<.#]/.test(text);

function entries() {
  const found = [];
  for (const room of ['protocol', 'render', 'server'])
    for (const name of fs.readdirSync(path.join(SOURCE, room), { recursive: true })) {
      const file = `${room}/${name}`;
      if (!/\.[ch]pp$/.test(file) || LEFT_OUT.test(file)) continue;
      const list = tokens(fs.readFileSync(path.join(SOURCE, file), 'utf8'));
      for (const { text, start } of texts(list)) {
        const [open, log] = [list[start - 1]?.text, list[start - 2]?.text];
        if (open === '(' && /^log_(info|warning|debug)$/.test(log)) found.push({ file, code: 'log', text });
        else if (isProse(text)) found.push({ file, code: codeOf(list, start), text });
      }
    }
  return found;
}

const all = entries();
const written = (list) => {
  const lines = list.map(({ file, code, text }) => `${file}${code ? ` [${code}]` : ''}: ${JSON.stringify(text).slice(1, -1).replace(/\\"/g, '"')}`);
  return `${HEAD}\n${[...new Set(lines)].sort().join('\n')}\n`;
};
const sentences = all.filter(({ code }) => code !== 'log');

test('the list of sentences is that of the source', () => {
  if (process.env.VRUT_RENEW) fs.writeFileSync(LIST, written(all));
  assert.equal(fs.readFileSync(LIST, 'utf8'), written(all), 'VRUT_RENEW=1 writes the list anew: read what has changed');
});

test('each code of the protocol has a sentence, and no other code has', () => {
  const { notice, serverError } = JSON.parse(fs.readFileSync(path.join(SOURCE, 'protocol/protocol.schema.json'), 'utf8')).$defs;
  const codes = [
    ...serverError.properties.code.enum.map((code) => `error ${code}`),
    ...notice.properties.code.enum.map((code) => `notice ${code}`),
  ];
  const used = new Set(sentences.map(({ code }) => code).filter(Boolean));
  // This comes with a sentence that is made elsewhere: of the scene's file.
  const passedOn = ['notice scene'];
  assert.deepEqual([...used, ...passedOn].sort(), codes.sort());
});

const each = (what, list, check) => test(what, () => {
  const wrong = list.filter((entry) => !check(entry)).map(({ file, code, text }) => `${file} [${code}]: ${text}`);
  assert.deepEqual(wrong, []);
});

const errors = sentences.filter(({ code }) => code?.startsWith('error'));
const notices = sentences.filter(({ code }) => code?.startsWith('notice'));

each('a notice is a whole sentence that begins with a capital', notices, ({ text }) => /^\p{Lu}/u.test(text));
each('an error begins small, or with what is at fault: it stands behind a colon, too', errors, ({ text }) => !/^\p{Lu}/u.test(text));
each('no sentence ends with a stop: what is behind it may go on', sentences, ({ text }) => !/[.!]$/.test(text));
each('spaces stand alone', sentences, ({ text }) => !/ {2}/.test(text));
each('an event of the log is one name', all.filter(({ code }) => code === 'log'), ({ text }) => /^[a-z]+(_[a-z]+)*$/.test(text));
// Words that mean too much, too little, or another thing in the field.
each('words are those of the field', sentences, ({ text }) => !/\b(pictures?|things?|texcoords?|poses?|tells?|told)\b/i.test(text));
