/**
 * The types of the viewer that its parts share. viewer.js makes a Viewer; hands/ and ui/ use one.
 *
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./settings.js').Settings} Settings
 * @typedef {import('./settings.js').PartialSettings} PartialSettings
 * @typedef {import('./settings.js').Camera} Camera
 *
 * @typedef {object} Hit  What a ray meets first.
 * @property {Vec3} voxel  The lowest voxel of the cell.
 * @property {number} level  Level of the cell; the root is 0.
 * @property {number} [face]  The face that the ray enters.
 * @property {Vec3} position  In world units.
 * @property {number} distance  From the ray's origin, in world units.
 * @property {Vec3} [color]
 *
 * @typedef {object} SceneInfo
 * @property {string} name
 * @property {number} levels
 * @property {number} resolution
 * @property {Vec3} origin
 * @property {number} voxelSize
 * @property {{low: Vec3, high: Vec3}} bounds  Of the set voxels, in world units.
 * @property {number} voxels
 * @property {number[]} dagNodesPerLevel
 * @property {number} fileBytes
 * @property {boolean} hasColors
 * @property {boolean} hasNormals
 * @property {{name?: string, vertices?: number, triangles?: number}} [source]
 * @property {Camera} view  The suggested view.
 *
 * @typedef {object} Statistics
 * @property {number} levelsLoaded
 * @property {number} levelsShown
 * @property {number} bytesLoaded
 * @property {number} fileBytes
 * @property {number} frameMs
 * @property {number} raysPerFrame
 * @property {number} stepsPerRay
 * @property {number} samples
 * @property {number} samplesWanted
 * @property {number} scale
 * @property {number} gpuBytes
 *
 * @typedef {object} Viewer
 * @property {HTMLCanvasElement} canvas
 * @property {SceneInfo | null} info  Null until the file's header is read.
 * @property {(event: string, handler: (...values: any[]) => void) => void} on
 * @property {(event: string, handler: (...values: any[]) => void) => void} off
 * @property {(settings: PartialSettings, by?: string) => void} set
 * @property {() => Settings} get
 * @property {(x: number, y: number) => Promise<Hit | null>} pick  CSS pixels from the canvas's corner.
 * @property {(origin: Vec3, direction: Vec3, distance: number) => Hit | null} castNow  Unit direction.
 * @property {(point: Vec3) => boolean} contains  Whether a point lies in a set voxel.
 * @property {(options: {width?: number, height?: number, samples?: number}) => Promise<Blob>} capture
 * @property {() => Promise<void>} whenStill
 * @property {() => Statistics} statistics
 * @property {() => void} frame
 * @property {() => void} destroy
 */
export {};
