// SPDX-License-Identifier: MIT
//
// The page: what is open, and what happens next. Files come by drop or by choice and stay handles; a worker judges them
// and its report appears in a frame that has the markup and the script of --report=html (report.html); another worker makes
// the file that is saved. A worker ends with its job.
import {Refusal, checkSize, filesOfDrop, filesOfList, optionsOfFormat} from './files.js';

const $ = id => document.getElementById(id);
const actions = $('actions'), frame = $('report');
const compiled = fetch('tool.wasm').then(answer => answer.arrayBuffer()).then(WebAssembly.compile);
compiled.catch(() => {}); // the job that waits for it says so

const STAGES = ['map', 'parse', 'decode', 'textures', 'normals', 'tangents', 'write', 'report'];
const STAGE_TEXT = {map: 'Opening', parse: 'Reading', decode: 'Reading', textures: 'Images', normals: 'Normals', tangents: 'Tangents', write: 'Writing', report: 'Report'};
const SMALL_BYTES = 1e6, PATIENCE_MS = 400; // what is small is done before a bar would be read

let files = []; // what is open: [{path, blob}]
let names = []; // of its meshes, as the report has them
let advised = false; // whether --fix repairs what the report found
let stop = () => {}; // ends the worker that is at work
let newest = 0;

// ---- what is seen ----

function show(state) {
	document.body.dataset.state = state;
}

function say(id, text) {
	$(id).hidden = !text;
	$(id).textContent = text;
}

function showStage(text) {
	const at = STAGES.indexOf(text), bar = document.querySelector('progress');
	if (at < 0) bar.removeAttribute('value');
	else bar.value = (at + 1) / (STAGES.length + 1);
	$('stage').textContent = (STAGE_TEXT[text] || text) + '…';
}

function setTheme(name) {
	for (const root of [document, frame.contentDocument]) {
		if (name) root.documentElement.dataset.theme = name;
		else delete root.documentElement.dataset.theme;
	}
	document.querySelectorAll('#theme button').forEach(b => b.setAttribute('aria-pressed', b.dataset.theme === name));
	frame.contentDocument.querySelector(`#theme [data-theme="${name}"]`)?.click(); // whose views are drawn anew
}

// ---- jobs ----

// A worker's answer to a job; undefined if the job was given up meanwhile.
async function run(job, state) {
	stop();
	say('failure', '');
	say('saved', '');
	showStage('Starting');
	const before = document.body.dataset.state, worker = new Worker('worker.js', {type: 'module'});
	const bytes = files.reduce((sum, file) => sum + file.blob.size, 0);
	const waited = setTimeout(show, bytes > SMALL_BYTES ? 0 : PATIENCE_MS, state);
	let given_up;
	try {
		return await new Promise((done, failed) => {
			given_up = done;
			stop = () => { given_up(); show(before); };
			worker.onerror = event => failed(new Error(event.message || 'The page is not complete: its worker does not start.'));
			worker.onmessage = ({data}) => {
				if (data.stage) showStage(data.stage);
				else if (data.failure) failed(new Refusal(data.failure));
				else done(data);
			};
			compiled.then(tool => worker.postMessage({tool, files, ...job}), failed);
		});
	} catch (error) {
		show(before);
		say('failure', error.message);
	} finally {
		clearTimeout(waited);
		worker.terminate();
		stop = () => {};
	}
}

// ---- opening ----

// Lets go of what is open, the report's memory too.
function close() {
	stop();
	files = [];
	frame.contentWindow.location.replace('about:blank');
	['failure', 'saved'].forEach(id => say(id, ''));
	show('empty');
}

async function open(coming) {
	const number = ++newest;
	close();
	try {
		const found = await coming;
		if (number !== newest) return;
		checkSize(found.reduce((sum, file) => sum + file.blob.size, 0), found.length === 1 ? 'This file has' : 'These files have');
		files = found;
	} catch (error) {
		say('failure', error.message);
		return;
	}
	const checked = files.length && await run({options: []}, 'busy');
	if (!checked || number !== newest) return;
	names = checked.names;
	await showReport(checked.report);
	if (number !== newest) return;
	offer();
	show('report');
}

// The elements of the report move into the frame's page, and the script that reads them is started. Images that are not in
// the report are not looked for.
async function showReport(html) {
	const report = new DOMParser().parseFromString(html.slice(html.indexOf('<script type="application/json"')), 'text/html'), data = report.getElementById('data'), content = JSON.parse(data.textContent);
	for (const mesh of content.files.flatMap(file => file.meshes))
		for (const picture of mesh.images) picture.file = null;
	data.textContent = JSON.stringify(content);
	await new Promise(done => { frame.onload = done; frame.contentWindow.location.replace('report.html'); });
	const page = frame.contentDocument, script = page.createElement('script');
	page.body.append(data, ...report.querySelectorAll('script[id^="g-"]'));
	await new Promise((done, failed) => {
		Object.assign(script, {src: 'report.js', onload: done, onerror: failed});
		page.body.append(script);
	});
	takeDrops(page);
	setTheme(document.documentElement.dataset.theme || '');
	advised = content.files.flatMap(file => file.findings).some(finding => finding.severity !== 'info' && finding.repair?.startsWith('nmtan --fix '));
	document.title = names.length === 1 ? names[0] + ' – nmtan' : 'nmtan';
}

// ---- saving ----

// The options chosen by hand, and what the report advises unless the tangents are decided by hand.
function chosenOptions() {
	const chosen = [...new FormData(actions)].filter(([, value]) => value).map(([name, value]) => `--${name}=${value}`);
	return advised && !$('actions').elements.existing.value ? ['--fix', ...chosen] : chosen;
}

// The output's name without its ending; not the input's own.
function stem() {
	if (names.length !== 1) return 'nmtan';
	const [, name, ending] = /([^/]*?)(\.[^./]*)?$/.exec(names[0]);
	return name + (ending?.toLowerCase() === '.' + $('format').value ? '-repaired' : '');
}

function offer() {
	const format = $('format').value, options = [...chosenOptions(), ...optionsOfFormat(format)];
	$('save').textContent = chosenOptions().includes('--fix') ? 'Repair and save' : 'Save';
	const quoted = text => /^[\w.,:@%+/=-]+$/.test(text) ? text : "'" + text.replaceAll("'", "'\\''") + "'";
	$('command').textContent = ['nmtan', ...options, ...names.length === 1 ? [quoted(names[0]), quoted(stem() + '.' + format)] :
		['-d', 'DIR', '--keep-tree=.', '--output-format=' + format, 'INPUT...']].join(' ');
}

async function save() {
	const saved = await run({options: chosenOptions(), save: {format: $('format').value, name: stem()}}, 'saving');
	if (!saved) return;
	show('report');
	say('saved', saved.said.join('\n'));
	const link = document.createElement('a');
	link.href = URL.createObjectURL(saved.blob);
	link.download = saved.name;
	link.click();
	setTimeout(() => URL.revokeObjectURL(link.href), 60000); // the browser has it by then
}

// ---- start ----

function takeDrops(page) {
	page.addEventListener('dragover', event => { event.preventDefault(); document.body.classList.add('over'); });
	page.addEventListener('dragleave', () => document.body.classList.remove('over'));
	page.addEventListener('drop', event => {
		event.preventDefault();
		document.body.classList.remove('over');
		open(filesOfDrop(event.dataTransfer));
	});
}

$('unstarted').remove();
takeDrops(document);
for (const input of [$('choose-files'), $('choose-folder')])
	input.addEventListener('change', () => { if (input.files.length) open(filesOfList(input.files)); input.value = ''; });
$('example').addEventListener('click', () => open(fetch('head.obj').then(async answer => [{path: 'head.obj', blob: await answer.blob()}])));
$('again').addEventListener('click', () => { newest++; close(); $('choose-files').focus(); });
$('cancel').addEventListener('click', () => { newest++; stop(); });
actions.addEventListener('change', offer);
actions.addEventListener('submit', event => { event.preventDefault(); save(); });
document.querySelectorAll('#theme button').forEach(b => b.addEventListener('click', () => setTheme(b.dataset.theme)));
document.addEventListener('keydown', event => { if (event.key === 'Escape') $('options').open = false; });
document.addEventListener('click', event => { if (!event.target.closest('#options')) $('options').open = false; });
window.addEventListener('blur', () => { $('options').open = false; }); // the report got the click
navigator.serviceWorker?.register('sw.js').catch(() => {}); // without one it works while there is a network
