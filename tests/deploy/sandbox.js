'use strict';
const { spawnSync } = require('node:child_process');
const { missing } = require('./helpers.js');

/** Why no sandbox can be made here, or false. */
const cannotSandbox = (...commands) => missing('bwrap', ...commands) ||
  (spawnSync('bwrap', ['--unshare-user', '--unshare-pid', '--ro-bind', '/', '/', '--dev', '/dev', '--proc', '/proc', '/bin/true']).status === 0
    ? false : 'bwrap may not make namespaces here');

module.exports = { cannotSandbox };
