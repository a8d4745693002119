'use strict';
const fs = require('node:fs');
const path = require('node:path');
const { output } = require('./helpers.js');

/** Writes certificate.pem of localhost, key.pem, and both.pem, which has the two, into a folder. */
function makeCertificate(folder) {
  const file = (name) => path.join(folder, name);
  output('openssl', [
    'req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:P-256', '-nodes', '-days', '2', '-subj', '/CN=localhost',
    '-addext', 'subjectAltName=DNS:localhost,IP:127.0.0.1', '-keyout', file('key.pem'), '-out', file('certificate.pem'),
  ]);
  fs.writeFileSync(file('both.pem'), fs.readFileSync(file('certificate.pem')) + fs.readFileSync(file('key.pem'), 'utf8'));
}

module.exports = { makeCertificate };
