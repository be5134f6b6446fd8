// SPDX-License-Identifier: MIT
//
// Two versions of an asset, of --diff: the old one stands left, the new one right. One of them is open as a single file
// would be; the other is its twin, whose views follow, and which a click opens. Changes are in the list.
//
// Frames are those of each version (authored) and of the other one at the same place (computed), so that their angle is the heat
// map.

const MOST_CHANGES = 100;
const versions = ['old', 'new'];
const unchanged = 'No finding is new or gone.';

// Draws `to` as `from` is drawn, and the reverse. Only the fields that changed are copied: both may change before either is drawn.
function link(from, to, fields) {
	const text = (view, name) => JSON.stringify(view[name] ?? null), known = Object.fromEntries(fields.map(name => [name, text(from, name)]));
	for (const [a, b] of [[from, to], [to, from]])
		a.ondraw = () => {
			if (!a.geometry || !b.geometry) return;
			const changed = fields.map(name => [name, text(a, name)]).filter(([name, value]) => value !== known[name]);
			if (!changed.length) return;
			for (const [name, value] of changed) {
				known[name] = value;
				b[name] = JSON.parse(value);
			}
			b.vectorLines = null;
			b.draw();
		};
}

class Twin {
	constructor(onpick) {
		FRAMES[0][1] = 'of this version';
		FRAMES[1][1] = 'of the other version';
		document.body.classList.add('diff');
		this.onpick = onpick;
		this.figures = ['layout', 'space'].map(id => {
			const canvas = element('canvas', {tabindex: 0, role: 'img', 'aria-label': id === 'layout' ? 'UV islands of the other version' : 'The other version in space'});
			const parts = {title: element('h2'), legend: element('p', {class: 'legend'}), canvas, empty: element('p', {class: 'empty'}), main: $(id + '-frame')};
			parts.figure = element('figure', {id: 'twin-' + id}, element('figcaption', {}, parts.title), parts.legend, element('div', {class: 'canvas'}, canvas, parts.empty));
			parts.main.after(parts.figure);
			return parts;
		});
		this.layout = new Layout(this.figures[0].canvas);
		this.layout.onpick = (triangle, again) => this.pick(triangle, again, 'layout');
		this.changes = element('div', {id: 'changes'}, ...data.diff.meshes.filter(m => m.changed).slice(0, MOST_CHANGES).map((m, i) => this.change(m, i < 3)));
		$('groups').before(this.changes);
	}

	change(m, open) {
		const version = m.new === null ? 0 : 1;
		return element('details', {class: 'group change', open}, element('summary', {}, element('span', {class: 'dot'}), element('span', {class: 'name'}, m.label), element('span', {class: 'number'})),
			element('dl', {}, ...m.rows.flatMap(([name, text]) => [element('dt', {}, name), element('dd', {}, text.replaceAll('->', '→'))])),
			element('button', {type: 'button', class: 'more', onclick: () => openFile(files[version], files[version].meshes[m[versions[version]]])}, 'Show'));
	}

	startSpace(space) {
		this.space = new Space(this.figures[1].canvas);
		this.space.onpick = (triangle, again) => this.pick(triangle, again, 'space');
		this.layout.oncoverage = (...window) => this.space.coverage(...window);
		link(space, this.space, ['camera', 'mode', 'frame', 'other', 'layout', 'wipe', 'flip', 'showBase', 'showSeams', 'showVectors', 'moving']);
		// where w is wrong in one of them, dents are seen beside bumps; a map of angles is as red on both sides
		for (const view of [space, this.space]) Object.assign(view, {mode: 0, frame: 0, other: -1, layout: 'wipe'});
		$('arrange').setAttribute('aria-label', 'How the two versions are shown');
		$('wipe').setAttribute('aria-label', 'Border between the old and the new version');
		if (this.mesh) this.load();
	}

	// Whether both versions have the mesh, to be seen.
	get paired() { return !!(this.mesh?.hasGeometry && mesh?.hasGeometry); }

	// Side by side, or in one frame with a wipe between them: then each canvas is cut off at the border. Returns whether it is so.
	arrange(space) {
		const {main, figure, canvas} = this.figures[1], wiped = this.paired && space.layout === 'wipe', {number} = this;
		if (wiped !== figure.hidden) {
			if (wiped) $('space').after(canvas);
			else figure.querySelector('.canvas').prepend(canvas);
			figure.hidden = wiped;
			document.body.classList.toggle('wiped', wiped);
		}
		main.querySelector('h2').textContent = 'Model, ' + (wiped ? 'old and new' : versions[number]);
		[space, this.space].forEach((view, i) => {
			const [from, to] = view.part = !wiped ? [0, 1] : number === i ? [0, space.wipe] : [space.wipe, 1];
			view.canvas.style.clipPath = wiped ? 'inset(0 ' + 100 * (1 - to) + '% 0 ' + 100 * from + '%)' : '';
			view.draw();
		});
		return wiped;
	}

	load() {
		this.space?.load(this.mesh, this.geometry);
		this.layout.load(this.mesh, this.geometry);
	}

	pick(triangle, again, from) {
		const {mesh} = this;
		if (triangle >= 0) openFile(mesh.file, mesh).then(() => pick(triangle, again, from));
	}

	// The mesh of the other version.
	async open(mesh) {
		const number = this.number = mesh.file.number, pair = data.diff.meshes.find(m => m[versions[number]] === mesh.number);
		const other = files[1 - number].meshes[pair?.[versions[1 - number]] ?? -1];
		this.figures.forEach(({title, legend, figure, main, empty}, i) => {
			const name = i ? 'Model, ' : 'Texture, ';
			main.querySelector('h2').textContent = name + versions[number];
			title.textContent = name + versions[1 - number];
			legend.textContent = !other ? '' : i ? plural(other.triangles, 'triangle') + ' · ' + plural(other.vertices, 'vertex', 'vertices') :
				plural(other.islands, 'island') + ' · ' + plural(other.mirrorSeams, 'mirror seam');
			main.style.order = 2 * i + number;
			figure.style.order = 2 * i + 1 - number;
			empty.textContent = other ? other.hasGeometry ? '' : 'No triangles to show.' : 'This version does not have the mesh.';
		});
		this.mesh = other;
		this.geometry = null;
		this.load();
		describe();
		const geometry = other && await openGeometry(other);
		if (this.mesh !== other || !geometry) return;
		this.geometry = geometry;
		this.load();
		describe();
	}

	draw() {
		this.layout.overlaps = null;
		this.layout.draw();
		this.space?.draw();
	}

	// The findings that only one version has.
	get changed() {
		return {findings: [...files].reverse().flatMap(f => f.findings.filter(x => !x.known)), failure: null};
	}

	summary() {
		showVerdict('New version: ' + files[1].verdict, files[1]);
		$('title').replaceChildren(element('span', {}, files[0].name), ' → ', element('span', {}, files[1].name));
		document.title = files[0].name + ' → ' + files[1].name + ' – nmtan';
		const [gone, fresh] = files.map(f => f.findings.filter(x => !x.known));
		const worst = severities.find(severity => fresh.some(x => x.severity === severity));
		$('summary').replaceChildren(element('span', {class: 'verdict ' + (worst || 'none')}, plural(fresh.length, 'new finding')),
			element('span', {class: 'verdict ' + (gone.length ? 'info' : 'none')}, count(gone.length) + ' gone'),
			element('span', {class: 'verdict none'}, count(data.diff.unchanged) + ' unchanged'));
	}
}
