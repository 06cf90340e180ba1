/**
 * Emscripten's threads, as many as the maker of the module asks for in Module.threads, the first one included; none: 1. They start
 * before the program, which cannot wait for them: its thread would have to leave the program.
 * Module.makeThread() makes their workers; none: emscripten makes them of voxdag.worker.js.
 */
{
  const pool = LibraryManager.library.$PThread;
  Object.assign(pool, {
    allocateNamedWorker: pool.allocateUnusedWorker,
    allocateUnusedWorker: function () {
      if (Module['makeThread']) PThread.unusedWorkers.push(Module['makeThread']());
      else PThread.allocateNamedWorker();
    },
    initMainThread: function () {
      for (let i = 1; i < (Module['threads'] || 1); ++i) PThread.allocateUnusedWorker();
    },
    loadWorker: pool.loadWasmModuleToWorker,
    loadWasmModuleToWorker: function (worker) {
      addRunDependency('a thread');
      PThread.loadWorker(worker, () => removeRunDependency('a thread'));
    },
  });
}
mergeInto(LibraryManager.library, {
  emscripten_num_logical_cores: function () {
    return Module['threads'] || 1;
  },
});
