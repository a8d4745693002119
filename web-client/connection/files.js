/**
 * Promises a file that the server makes, or an Error with its sentence; its code `not-sent` says that there is no
 * connection.
 *
 * @param {string} name
 * @param {string|undefined} token
 * @param {string} [page] its address
 */
export async function fetchFile(name, token, page = document.baseURI) {
  /** @type {Record<string, string>} */
  const headers = token ? { Authorization: `Bearer ${token}` } : {};
  const response = await fetch(new URL(name, page), { headers }).catch(() => {
    throw Object.assign(new Error(), { code: 'not-sent' });
  });
  if (!response.ok) throw new Error((await response.text()).trim());
  return response.blob();
}
