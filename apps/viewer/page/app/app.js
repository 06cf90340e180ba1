import {VERSION} from '../constants.js';

document.title = `voxdag ${VERSION}`;
