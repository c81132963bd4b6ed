// Gives a program of Emscripten the environment of Node.
Module["preRun"] = () => {
  if (typeof ENV !== "undefined") { // the program asks for variables
    Object.assign(ENV, process.env);
  }
};
