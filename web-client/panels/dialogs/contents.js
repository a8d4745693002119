/** What is loaded when a dialog is opened first: all of them, for each by itself would share other parts with the page. */
export { deletion } from './deletion.js';
export { showDialog } from './dialog.js';
export { help } from './help.js';
export { people } from './people.js';
export { settings } from './settings.js';
