// SPDX-License-Identifier: MIT
//
// The page: which file and mesh are open, and what is chosen, in the list and in both views at once.
//
// The address says what is shown: #file-3 a file, #finding-12 a finding of the page.

// ---- colours ----

// A colour of page.css as it is now: [red, green, blue], 0 to 255, and alpha if it has one; for WebGL; and as a text for a canvas.
// A canvas keeps it if the system forces colours.
const colours = new Map();
function colourOf(name) {
	if (!colours.has(name)) {
		const canvas = $('layout');
		canvas.style.textDecorationColor = 'var(--' + name + ')';
		colours.set(name, getComputedStyle(canvas).textDecorationColor.match(/[\d.]+/g).map(Number));
	}
	return colours.get(name);
}
const lightOf = name => colourOf(name).map(x => x / 255);
const ink = (name, alpha) => 'rgba(' + colourOf(name).slice(0, alpha ? 3 : 4) + (alpha ? ', ' + alpha : '') + ')';
const fontFamily = () => 'system-ui, sans-serif';

function setTheme(name) {
	if (name) document.documentElement.dataset.theme = name;
	else delete document.documentElement.dataset.theme;
	document.querySelectorAll('#theme button').forEach(b => b.setAttribute('aria-pressed', b.dataset.theme === name));
	colours.clear();
	layout.overlaps = null;
	layout.draw();
	space?.draw();
	twin?.draw();
	if (!$('overview').hidden) overview.show();
}

// ---- parts ----

const layout = new Layout($('layout'));
let space = null, spaceFailure = '';
const list = new Findings(finding => choose({finding}));
const overview = new Overview();
const twin = data.diff ? new Twin(pick) : null;
let file = null, mesh = null, geometry = null, selection = null;

// ---- choosing ----

const islandOf = t => geometry.islands[t] - 1;

// Contents of a selection: {triangles, seams, text, related}.
function resolve({finding, island, seam, triangle}) {
	const mine = file.findings.filter(x => x.mesh === mesh.number || x.mesh === (mesh.same_as ?? -1));
	if (finding) {
		const local = geometry ? finding.at.map(t => localTriangle(geometry, t)).filter(t => t !== undefined) : [];
		const seams = finding.seam !== null ? [finding.seam] : [];
		let triangles = local;
		if (geometry && finding.seam !== null) triangles = trianglesOfSeam(geometry, finding.seam);
		else if (geometry && finding.island !== null) triangles = trianglesOfIsland(geometry, finding.island);
		return {triangles, seams, spots: local, text: finding.message, related: []};
	}
	if (seam !== undefined) {
		const [edges, closed, long, plane, a, b, hard] = mesh.seamList[seam] || [];
		return {triangles: trianglesOfSeam(geometry, seam), seams: [seam], related: mine.filter(x => x.seam === seam),
			text: (hard ? 'Hard edges ' : 'Mirror seam ') + seam + (edges ? ': ' + plural(edges, 'edge') + (closed ? ', closed' : '') + ', length ' + Number(long.toPrecision(4)) +
				(plane ? ', in ' + plane : '') + (a !== null && !hard ? ', between island ' + a + ' and ' + (a === b ? 'itself' : b) : '') : '')};
	}
	if (triangle !== undefined) {
		const number = geometry.numbers ? [...geometry.numbers].find(([, t]) => t === triangle)[0] : triangle;
		const kind = ['mirrored', 'degenerate', 'unmirrored'][geometry.kinds[triangle] & 3];
		return {triangles: [triangle], seams: [], related: mine.filter(x => x.at.includes(number)),
			text: 'Triangle ' + number + ', ' + kind + (islandOf(triangle) >= 0 ? ', of island ' + islandOf(triangle) : '')};
	}
	const triangles = trianglesOfIsland(geometry, island), kinds = [0, 0, 0];
	for (const t of triangles) kinds[geometry.kinds[t] & 3]++;
	const related = mine.filter(x => x.island === island);
	return {triangles, seams: [], related, text: 'Island ' + island + ': ' + plural(triangles.length, 'triangle') + ', ' +
		(kinds[0] && kinds[2] ? count(kinds[2]) + ' unmirrored and ' + count(kinds[0]) + ' mirrored' : kinds[0] ? 'mirrored' : kinds[2] ? 'unmirrored' : 'degenerate') +
		(related.length ? '' : ', no finding')};
}

async function choose(what, options = {}) {
	if (what.finding) {
		if (what.finding.file !== file) openFile(what.finding.file);
		const wanted = what.finding.mesh === null ? mesh : file.meshes[what.finding.mesh];
		if (wanted && wanted !== mesh) await openMesh(wanted);
		else await loading;
		await painted;
		history.replaceState(null, '', '#finding-' + what.finding.number);
	}
	selection = what;
	const {triangles, seams, spots = [], text, related} = mesh ? resolve(what) : {triangles: [], seams: [], text: what.finding.message, related: []};
	Object.assign(selection, {triangles, spots, spot: -1});
	selection.island = what.island;
	list.choose(what.finding || null, related);
	layout.choose(triangles, seams);
	space?.choose(triangles, seams);
	showVotes(what.finding?.votes);
	if (!options.still) {
		if (options.from !== 'layout') layout.focus();
		if (options.from !== 'space') space?.focus();
	}
	if (what.finding && matchMedia('(max-width: 900px)').matches) $('stage').scrollIntoView();
	$('selection').hidden = false;
	$('selection-text').textContent = $('selection-text').title = text;
	$('selection-show').hidden = !triangles.length;
	tellSpot();
}

// The place of the finding that is shown, of those that the report has: it may have found more.
function tellSpot() {
	const {spots, spot, finding} = selection, more = finding && finding.count > spots.length;
	$('spots').hidden = spots.length < 2 && !(spots.length && selection.triangles.length > 1);
	$('spot-text').textContent = (spot < 0 ? '' : spot + 1 + ' / ') + plural(spots.length, 'place') + (more && finding.seam === null && finding.island === null ? ' of ' + count(finding.count) : '');
}

// Shows the next place of the chosen finding, or the one before.
function goToSpot(step) {
	const {spots, spot} = selection || {spots: []};
	if (!spots.length) return;
	selection.spot = (spot < 0 && step < 0 ? spots.length - 1 : spot + step + spots.length) % spots.length;
	for (const view of [layout, space]) {
		view?.choose([spots[selection.spot]], []);
		view?.focus();
	}
	tellSpot();
}

// The evidence for which way green points, on the normal map.
function showVotes(votes) {
	layout.votes = geometry?.texcoords ? votes || null : null;
	if (layout.votes && mesh.pictures[0].source) layout.shown = Number($('texture').value = 0);
	layout.draw();
	noteLayout();
}

function chooseNothing() {
	selection = null;
	showVotes(null);
	list.choose(null, []);
	layout.choose([], []);
	space?.choose([], []);
	$('selection').hidden = true;
	if (location.hash.startsWith('#finding')) history.replaceState(null, '', files.length > 1 ? '#file-' + file.number : '#');
}

// A click in a view: the island; inside of the chosen island, the triangle.
function pick(triangle, again, from) {
	if (triangle < 0) { chooseNothing(); return; }
	const island = islandOf(triangle);
	const inside = selection && (selection.island === island || selection.finding?.island === island || selection.inIsland === island);
	if (again || inside || island < 0) choose({triangle, inIsland: island}, {from});
	else choose({island}, {from});
}

// ---- what is open ----

let loading = Promise.resolve();

function empty(id, text) {
	$(id).hidden = !text;
	$(id).textContent = text;
}

function openMesh(next) {
	mesh = next;
	geometry = null;
	$('mesh').value = mesh.number;
	const twinOpening = twin?.open(mesh);
	$('facts').replaceChildren(element('dt', {}, 'tangents'), element('dd', {}, mesh.why),
		...mesh.facts.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]));
	$('summary-of-mesh').textContent = mesh.triangles ? [plural(mesh.triangles, 'triangle'), plural(mesh.vertices, 'vertex', 'vertices'), plural(mesh.islands, 'island'),
		plural(mesh.mirrorSeams, 'mirror seam')].join(' · ') : mesh.why;
	offerPictures();
	layout.load(mesh, null);
	space?.load(mesh, null);
	empty('layout-empty', mesh.hasGeometry ? 'Opening…' : 'No triangles to show: ' + mesh.why + '.');
	empty('space-empty', spaceFailure || (mesh.hasGeometry ? 'Opening…' : 'No triangles to show.'));
	const opening = openGeometry(mesh).then(g => {
		if (mesh !== next || !g) return;
		geometry = g;
		layout.load(mesh, g);
		space?.load(mesh, g);
		empty('layout-empty', g.texcoords ? '' : 'This mesh has no texture coordinates.');
		empty('space-empty', spaceFailure);
		offerFrames();
		describe();
	}, failure => ['layout-empty', 'space-empty'].forEach(id => empty(id, 'The geometry cannot be read: ' + failure.message)));
	loading = Promise.all([opening, twinOpening]);
	return loading;
}

function openFile(next, wanted) {
	file = next;
	selection = null;
	$('selection').hidden = true;
	$('overview').hidden = true;
	$('file').hidden = false;
	$('title').replaceChildren(...(files.length > 1 || data.index ? [element('a', {href: data.index || '#'}, 'All files'), ' / '] : []), element('span', {}, file.name));
	document.title = file.name + ' – nmtan report';
	summary(file.counts, file);
	$('mesh').replaceChildren(...file.meshes.map(m => new Option(m.label + (m.same_as === null ? '' : ' (same geometry as ' + file.meshes[m.same_as].label + ')'), m.number)));
	$('mesh-field').hidden = file.meshes.length < 2;
	$('stage').hidden = !file.meshes.length;
	$('list').querySelector('.toolbar').hidden = !!file.failure;
	if (!twin) list.load(file);
	const first = wanted || file.meshes.find(m => m.number === file.findings.find(x => x.mesh !== null && file.meshes[x.mesh].hasGeometry)?.mesh) ||
		file.meshes.find(m => m.hasGeometry) || file.meshes[0];
	twin?.summary();
	if (first) return openMesh(first);
	mesh = geometry = null;
	return Promise.resolve();
}

function openOverview() {
	file = mesh = geometry = null;
	$('file').hidden = true;
	$('overview').hidden = false;
	$('title').textContent = plural(files.length, 'file');
	document.title = 'nmtan report';
	summary([0, 1, 2].map(i => files.reduce((sum, f) => sum + f.counts[i], 0)), null);
	const failed = files.filter(f => f.failure).length;
	if (failed) $('summary').prepend(element('span', {class: 'verdict error'}, plural(failed, 'file') + ' could not be judged'));
	overview.show();
}

// The text of a verdict may be cut at its end, its command never.
function showVerdict(text, file) {
	const command = file?.findings.map(x => x.repair).find(repair => repair && text.endsWith(': ' + repair)) || '';
	const said = text.slice(0, text.length - command.length);
	$('verdict').replaceChildren(element('span', {title: said}, said), ...command ? [element('code', {}, command)] : []);
}

// The verdict is the first thing to be read; what could not be judged has no counts.
function summary(counts, file) {
	const level = !file ? null : file.failure || counts[0] ? 'error' : counts[1] ? 'warning' : 'good';
	$('verdict').hidden = !file;
	$('verdict').className = level;
	showVerdict(file?.verdict || '', file);
	$('summary').replaceChildren(...(file?.failure ? [] : severities.map((severity, i) => element('span', {class: 'verdict ' + (counts[i] ? severity : 'none')}, plural(counts[i], severity)))));
}

function follow() {
	const [, kind, number] = /^#(file|finding)-(\d+)$/.exec(location.hash) || [];
	if (data.folder) openOverview();
	else if (kind === 'finding' && findings[number]) choose({finding: findings[number]});
	else if (kind === 'file' && files[number]) { if (file !== files[number]) openFile(files[number]); }
	else if (files.length === 1 || twin) { if (!file) openFile(files.at(-1)); }
	else openOverview();
}

// ---- frames ----

const frameNames = Object.fromEntries(FRAMES);

// Which frames this mesh has.
function framesThere() {
	return FRAMES.map(([id]) => id === 'screen' ? geometry.texcoords : geometry[id]).map(there => !!there);
}

function offerFrames() {
	if (!space) return;
	const there = framesThere();
	const option = (i, text) => { const o = new Option(text, i); o.disabled = !there[i]; return o; };
	$('frame').replaceChildren(...FRAMES.map(([, name], i) => option(i, name)));
	$('other').replaceChildren(new Option('nothing', -1), ...FRAMES.map(([, name], i) => option(i, name)));
	if (!there[space.frame] && !(twin && space.mode === 0)) space.frame = (twin ? [0, 2] : [1, 0, 2]).find(i => there[i]) ?? 2;
	if (space.other >= 0 && !there[space.other] && !twin) space.other = -1;
	$('frame').value = space.frame;
	$('other').value = space.other;
}

function describe() {
	if (!space) return;
	const wiped = twin?.arrange(space);
	if (!geometry) return;
	const mode = MODES[space.mode][0], two = twin ? twin.paired : space.other >= 0 && mode !== 'angle', parts = [];
	const flips = mode === 'lit' && !!(space.images.bump || twin?.space.images.bump);
	$('flip').closest('label').hidden = !flips;
	$('base').closest('label').hidden = mode !== 'lit' || !(space.images.base || twin?.space.images.base);
	if (flips && space.flip) parts.push('Green is flipped here, not in the file.');
	else if (mode === 'lit') parts.push(space.images.bump ? 'Lit by the normal map.' : 'Lit with a test pattern of domes: ' + (mesh.pictures[0].file ? 'the normal map is not in this page.' : mesh.mapped ? 'the normal map is not decoded here (KTX2 is not), or too large for the page.' : 'there is no normal map here.'));
	if (mode === 'angle') parts.push('The angle between the tangents ' + frameNames[FRAMES[space.frame][0]] + ' and those ' + ((space.other < 0 || space.other === 2) ? 'of screen derivatives' : frameNames[FRAMES[space.other][0]]) + '; 180° where the handedness differs.');
	if (mode === 'angle' && twin) parts.push('Grey: the other version has no triangle here, or there are no tangents.');
	if (mode === 'skew') parts.push('How far tangents lean out of the plane of the normal.');
	if (mode === 'sign' || mode === 'winding') parts.push('Blue: unmirrored. Red: mirrored.');
	if (!geometry.normals) parts.push('The mesh has no normals; faces are shown flat.');
	if (!geometry.whole) parts.push(count(geometry.triangles) + ' of ' + count(mesh.triangles) + ' triangles: the neighbourhood of the findings. A page holds three million.');
	$('space-note').textContent = parts.join(' ');
	$('heat').hidden = mode !== 'angle' && mode !== 'skew';
	$('heat-high').textContent = mode === 'skew' ? '30°' : '90°';
	$('arrange').hidden = !two;
	$('wipe').hidden = !two || space.layout !== 'wipe';
	$('wipe').style.left = 100 * space.wipe + '%';
	$('wipe').setAttribute('aria-valuenow', Math.round(100 * space.wipe));
	document.querySelectorAll('#arrange button').forEach(b => b.setAttribute('aria-pressed', b.dataset.layout === space.layout));
	['left-name', 'right-name'].forEach((id, i) => {
		$(id).hidden = !(twin ? wiped : two);
		$(id).textContent = twin ? versions[i] : two ? frameNames[FRAMES[i ? space.other : space.frame][0]] : '';
	});
	$('frame').closest('label').hidden = twin || ['winding', 'checker', 'normal'].includes(mode);
	$('other').closest('label').hidden = twin || ['winding', 'checker', 'normal'].includes(mode);
}

const pictureNames = ['Normal map', 'Base colour'];
let wanted = null; // by hand, else what the page has in itself

// The images of the mesh.
function offerPictures() {
	const there = mesh.pictures.map(p => p.source || p.file);
	$('texture').replaceChildren(new Option('No image', -1), ...there.flatMap((source, i) => source ? [new Option(pictureNames[i], i)] : []));
	$('texture').closest('label').hidden = !there.some(source => source);
	layout.shown = wanted === null || (wanted >= 0 && !there[wanted]) ? mesh.pictures.findIndex(p => p.source) : wanted;
	$('texture').value = layout.shown;
}

// Names the missing image under the islands, and tints.
function noteLayout() {
	const {overlaps, showOverlaps} = layout, repeated = showOverlaps && overlaps?.repeated;
	$('fill').value = 100 * layout.opacity;
	if (layout.votes) {
		$('layout-note').textContent = 'Blocks of the normal map whose green points up (▲) or down (▼).';
		return;
	}
	$('layout-note').textContent = (layout.missing ? 'No image: ' + layout.missing + ' is not beside this page, or this browser cannot show it. ' : '') +
		(!showOverlaps || !overlaps ? '' : overlaps.repeated === null ? 'Overlaps of one tile with another are not shown: too many are in view; zoom in.' :
		repeated ? 'Overlaps count all tiles as one, since the texture repeats.' : '');
}

function changeSpace(change) {
	Object.assign(space, change);
	if (twin && geometry && 'mode' in change) Object.assign(space, space.mode === 7 ? {frame: 0, other: 1} : {frame: space.mode === 0 || framesThere()[0] ? 0 : 2, other: -1});
	if ('frame' in change) space.vectorLines = null;
	if (space.mode === 7 && (space.other < 0 || space.other === space.frame)) {
		const there = framesThere();
		space.other = [1, 2, 0].find(i => there[i] && i !== space.frame) ?? -1;
		$('other').value = space.other;
	}
	describe();
	space.draw();
}

// ---- start ----

if (twin) { link(layout, twin.layout, ['view', 'fitted', 'shown', 'showOverlaps', 'fill']); list.load(twin.changed); }
layout.onpick = (triangle, again) => pick(triangle, again, 'layout');
layout.onoverlaps = layout.onpicture = noteLayout;
layout.onseam = seam => choose({seam}, {from: 'layout'});
layout.onhover = (u, v) => { $('layout-readout').textContent = u === null || u === undefined || !layout.geometry ? '' : 'u ' + u.toFixed(4) + '  v ' + (1 - v).toFixed(4); };
MODES.forEach(([, name], i) => $('mode').append(new Option(name, i)));
for (const name of ['mode', 'frame', 'other']) $(name).addEventListener('change', e => changeSpace({[name]: Number(e.target.value)}));
for (const [id, name] of [['flip', 'flip'], ['base', 'showBase'], ['seams', 'showSeams'], ['vectors', 'showVectors']])
	$(id).addEventListener('change', e => changeSpace({[name]: e.target.checked}));
$('fill').addEventListener('input', e => { layout.fill = e.target.value / 100; layout.draw(); });
$('texture').addEventListener('change', e => { wanted = layout.shown = Number(e.target.value); });
$('overlaps').addEventListener('change', e => { layout.showOverlaps = e.target.checked; layout.draw(); noteLayout(); });
$('layout-fit').addEventListener('click', () => layout.fit());
$('space-fit').addEventListener('click', () => { if (geometry) space?.home(); });
$('selection-show').addEventListener('click', () => choose(selection));
$('spot-before').addEventListener('click', () => goToSpot(-1));
$('spot-next').addEventListener('click', () => goToSpot(1));
$('selection-clear').addEventListener('click', chooseNothing);
$('mesh').addEventListener('change', e => { chooseNothing(); openMesh(file.meshes[e.target.value]); });
document.querySelectorAll('#arrange button').forEach(b => b.addEventListener('click', () => changeSpace({layout: b.dataset.layout})));
document.querySelectorAll('#theme button').forEach(b => b.addEventListener('click', () => setTheme(b.dataset.theme)));
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => setTheme(document.documentElement.dataset.theme || ''));
$('wipe').addEventListener('pointermove', e => {
	if (!(e.buttons & 1)) return;
	const box = $('space').getBoundingClientRect();
	changeSpace({wipe: clamp((e.clientX - box.left) / box.width, 0, 1)});
});
$('wipe').addEventListener('pointerdown', e => e.target.setPointerCapture(e.pointerId));
$('wipe').addEventListener('keydown', e => {
	const step = {ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1}[e.key];
	if (!step) return;
	e.preventDefault();
	changeSpace({wipe: clamp(space.wipe + step, 0, 1)});
});
document.addEventListener('keydown', e => {
	const typing = /^(INPUT|SELECT|TEXTAREA)$/.test(e.target.tagName);
	if (e.key === 'Escape' && selection) chooseNothing();
	else if ((e.key === 'n' || e.key === 'p') && !typing) goToSpot(e.key === 'n' ? 1 : -1);
	else if (e.key === '/' && !typing) { $($('file').hidden ? 'file-text' : 'text').focus(); e.preventDefault(); }
	else if ((e.key === 'j' || e.key === 'k') && !typing && file && findings.length) {
		const shown = [...document.querySelectorAll('.group[open] .finding')].map(b => findings[b.dataset.finding]);
		const at = shown.indexOf(selection?.finding), next = shown[e.key === 'j' ? at + 1 : Math.max(at - 1, 0)];
		if (next) choose({finding: next}).then(() => list.rows.get(next)?.focus({preventScroll: true}));
	}
});
// WebGL takes longer to begin than all else: what there is to read is painted before.
function startSpace() {
	try {
		space = new Space($('space'));
	} catch (failure) {
		spaceFailure = 'No 3D view: ' + failure.message + '. The findings and the texture view work without; overlaps are not tinted.';
		empty('space-empty', spaceFailure);
		document.body.classList.add('flat');
		return;
	}
	space.onpick = (triangle, again) => pick(triangle, again, 'space');
	space.onimage = describe;
	layout.oncoverage = (...window) => space.coverage(...window);
	twin?.startSpace(space);
	if (geometry) {
		space.load(mesh, geometry);
		offerFrames();
		describe();
		layout.draw();
	}
}
const painted = new Promise(done => requestAnimationFrame(() => setTimeout(done))).then(startSpace);
window.addEventListener('hashchange', follow);
window.addEventListener('beforeprint', () => document.querySelectorAll('.group').forEach(g => { g.open = true; }));
follow();

// The state that tests look at.
window.nmtanReport = Object.freeze({
	ready: () => painted.then(() => loading),
	camera: () => space && {...space.camera, eye: space.eye(space.camera)},
	layout: () => ({...layout.view, width: layout.width, height: layout.height}),
	place: (u, v) => [layout.x(u), layout.y(v)],
	geometry: () => geometry,
	selection: () => selection && {...selection, finding: selection.finding?.number, triangles: selection.triangles.length},
	labels: () => layout.labels,
	overlapPixels: () => layout.overlapPixels,
	visible: () => space.visible(space.camera),
	drawn: () => space.shown.count / 3,
	twin: () => twin && {geometry: twin.geometry, camera: twin.space?.camera, view: twin.layout.view, mode: twin.space?.mode},
	turn: (x, y = 0) => space.turn(x, y),
});
