// What other people's origami libraries say of FOLD files.
//
//     node judge.js FOLDER_OF_NODE_MODULES [--opx] FILE.fold... FILE.opx...
//
// prints one JSON object: for each file what Rabbit Ear's validator finds, how many faces FOLD's own
// library finds from the lines alone, how far the form that Rabbit Ear folds from the angles is off
// the one in the file (null where it is its mirror image), and (--opx) the assignments after a way through ORIPA's format and back;
// for each .opx file the assignments that FOLD's own library reads.

const fs = require("fs");
const path = require("path");

const [modules, ...words] = process.argv.slice(2);
const FOLD = require(path.join(modules, "fold"));
const ear = require(path.join(modules, "rabbit-ear"));

const count = (letters) =>
  letters.reduce((found, letter) => ({ ...found, [letter]: (found[letter] || 0) + 1 }), {});

const apart = (a, b) => Math.hypot(...a.map((value, axis) => value - b[axis]));

// The largest difference between the distances of vertices in two forms, mm.
function difference(one, two) {
  let worst = 0;
  const step = Math.max(1, Math.floor(one.length / 50));
  for (let i = 0; i < one.length; i += 1) {
    for (let j = i % step; j < one.length; j += step) {
      worst = Math.max(worst, Math.abs(apart(one[i], one[j]) - apart(two[i], two[j])));
    }
  }
  return worst;
}

// Six times the volume of the tetrahedron of four points; its sign tells a form from its mirror image.
function volume(form, [a, b, c, d]) {
  const [u, v, w] = [b, c, d].map((k) => form[k].map((value, axis) => value - form[a][axis]));
  const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  return cross[0] * w[0] + cross[1] * w[1] + cross[2] * w[2];
}

// A face and the vertex with which it makes the largest tetrahedron.
function stoutest(form, face) {
  const corners = face.slice(0, 3);
  const volumes = form.map((_, k) => Math.abs(volume(form, [...corners, k])));
  return [...corners, volumes.indexOf(Math.max(...volumes))];
}

function folded(graph) {
  const form = (graph.file_frames || []).find((frame) => frame.frame_classes.includes("foldedForm"));
  if (!form) return null;
  const theirs = ear.graph.makeVerticesCoordsFolded(graph);
  const four = stoutest(form.vertices_coords, graph.faces_vertices[0]);
  const turned = volume(theirs, four) * volume(form.vertices_coords, four) < 0;
  return turned ? null : difference(theirs, form.vertices_coords);
}

// How many faces FOLD's own library finds from the lines alone; null where it finds no way.
function found(graph) {
  const vertices_coords = graph.vertices_coords.map((place) => place.slice(0, 2));
  const edges_vertices = graph.edges_vertices.map((edge) => edge.slice());
  const lines = { vertices_coords, edges_vertices };
  try {
    return FOLD.convert.edges_vertices_to_faces_vertices_edges(lines).faces_vertices.length;
  } catch {
    return null;
  }
}

function judge(file, throughOpx) {
  const graph = JSON.parse(fs.readFileSync(file, "utf8"));
  const verdict = ear.graph.validate(graph);
  const told = {
    summary: verdict.summary,
    doubled: verdict.vertices.duplicate.length,
    counts: count(graph.edges_assignment),
    faces: (graph.faces_vertices || []).length,
    found: found(graph),
    off: folded(graph),
  };
  if (throughOpx) {
    const { fromFold, toFold } = FOLD.convert.oripa;
    told.back = count(toFold(fromFold(graph)).edges_assignment);
  }
  return told;
}

const files = words.filter((word) => word !== "--opx");
const read = (file) =>
  file.endsWith(".opx")
    ? { back: count(FOLD.convert.oripa.toFold(fs.readFileSync(file, "utf8")).edges_assignment) }
    : judge(file, words.includes("--opx"));
const told = files.map((file) => [path.basename(file), read(file)]);
console.log(JSON.stringify(Object.fromEntries(told)));
