// import.mjs FOLDER FILE: prints the result of occt-import-js, installed in FOLDER, for a STEP
// file, as JSON.
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';

const [folder, file] = process.argv.slice(2);
const reader = await createRequire(`${folder}/`)('occt-import-js')();
const options = {linearDeflectionType: 'absolute_value', linearDeflection: 0.02, angularDeflection: 0.1};
const {success, meshes} = reader.ReadStepFile(new Uint8Array(readFileSync(file)), options);
process.stdout.write(JSON.stringify({success, meshes: meshes.map((mesh) => ({points: mesh.attributes.position.array, index: mesh.index.array}))}));
