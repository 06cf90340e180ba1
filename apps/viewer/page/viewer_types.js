/**
 * The types of the viewer that its parts share. viewer.js makes a Viewer; hands/ and ui/ use one.
 *
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./settings.js').Settings} Settings
 * @typedef {import('./settings.js').PartialSettings} PartialSettings
 * @typedef {import('./settings.js').Camera} Camera
 *
 * @typedef {object} Hit  The first cell that a ray meets.
 * @property {Vec3} voxel  The lowest voxel of the cell.
 * @property {number} level  Level of the cell; the root is 0.
 * @property {number} face  The side through which the ray enters: 2 * axis, plus 1 for the upper side; -1 if it starts inside.
 * @property {Vec3} position  In world units.
 * @property {number} distance  From the ray's origin, in units of its direction.
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
 * @property {string[] | null} materials  Names by id; null if the file has none.
 * @property {{name: string, kind: string, bound: number}[]} channels  kind: 'u8', 'u16', 'i16', 'i32' or 'f32'.
 * @property {{name?: string, vertices?: number, triangles?: number}} [source]
 * @property {Camera} view  The suggested view.
 * @property {(Camera & {sun?: Vec3}) | null} home  The view of the file, with a sun if it is an interior.
 * @property {import('./settings.js').Unit | null} unit  Of world coordinates, if the file says it.
 * @property {boolean} isWhole  Whether the graphics card can hold all levels; else the page shows the upper ones, without colours and channels.
 * @property {boolean} cubes  Whether its voxels are cubes, not samples of smooth surfaces.
 *
 * @typedef {object} Statistics
 * @property {number} levelsLoaded  Levels of cells that have arrived.
 * @property {number} levelsShown
 * @property {number} bytesLoaded
 * @property {number} fileBytes
 * @property {number} frameMs  Milliseconds that a frame takes, smoothed.
 * @property {number} raysPerFrame
 * @property {number} stepsPerRay  Mean steps of the view rays.
 * @property {number} samples  View samples per pixel of the picture; 0 while it has larger pixels.
 * @property {number} samplesWanted  Of the finished picture.
 * @property {number} scale  Side of the picture in its own pixels, relative to the canvas's.
 * @property {number} gpuBytes  Bytes of all textures.
 *
 * @typedef {object} Viewer
 * @property {HTMLCanvasElement} canvas
 * @property {SceneInfo | null} info  Null until the file's header is read.
 * @property {string | null} file  The name of the file that was opened on this computer.
 * @property {(file: File, options?: {keepsPlaces?: boolean}) => Promise<void>} open  Shows the scene of a .vdag file or of a page; throws Error if the file has none.
 *   `keepsPlaces`: camera, section, measures and notes stay.
 * @property {() => Promise<Blob>} scene  The .vdag file of the scene.
 * @property {(event: string, handler: (...values: any[]) => void) => void} on
 * @property {(event: string, handler: (...values: any[]) => void) => void} off
 * @property {(settings: PartialSettings, by?: string) => void} set
 * @property {() => Settings} get
 * @property {() => Camera} camera  The camera in force: that of the settings, else the suggested view.
 * @property {(x: number, y: number, root?: number) => Promise<Hit | null>} pick  CSS pixels from the canvas's corner; `root`: of another version of an edited scene.
 * @property {(act: (memory: import('./scene_memory.js').SceneMemory, textures: import('./gpu/scene_textures.js').SceneTextures) => void,
 *   goesOn: boolean) => void} change  Lets a function change the scene, and draws it; `goesOn`: more changes follow soon.
 * @property {(origin: Vec3, direction: Vec3, distance: number) => Hit | null} castNow  Unit direction.
 * @property {(hit: Hit) => number | null} material  Its id; null without materials.
 * @property {() => {name: string, values: [number, number], range: [number, number], colors: number[][]} | null} channel  The channel that is shown, once it has
 *   arrived: the least and the greatest of its values; those of the first and the last colour; and the colours, at equal distances.
 * @property {(hit: Hit) => number | null} channelValue  The value of the channel that is shown; null without one, and for cells that edits added.
 * @property {() => number[] | null} materialCounts  Cells of the finest level with materials, by id; null before they have arrived, and for very large scenes.
 * @property {(point: Vec3) => boolean} contains  Whether a point lies in a set voxel.
 * @property {(options?: {width?: number, height?: number, samples?: number, camera?: Camera, signal?: AbortSignal,
 *   progress?: (part: number) => void}) => Promise<Blob>} capture  `camera`: another than the one in force; `progress` takes 0 to 1.
 * @property {() => Promise<void>} whenStill
 * @property {() => Statistics} statistics
 * @property {() => [number, number] | null} shownRange  The values that the views level, steps and sharing show darkest and brightest; binary logarithms for sharing.
 * @property {() => void} frame
 * @property {() => void} destroy
 */
export {};
