// SPDX-License-Identifier: MIT
//
// The first page of many files: a row each, the worst first. Pictures of their texture layouts are made when a row comes
// into view, of files that are small enough; the index of a folder has them made.

const MOST_THUMB_TRIANGLES = 60000;

const fileColumns = [
	['worst', '', null],
	['name', 'File', (a, b) => a.name < b.name ? -1 : a.name > b.name ? 1 : 0],
	['error', 'Errors', (a, b) => a.counts[0] - b.counts[0]],
	['warning', 'Warnings', (a, b) => a.counts[1] - b.counts[1]],
	['info', 'Infos', (a, b) => a.counts[2] - b.counts[2]],
	['triangles', 'Triangles', (a, b) => a.triangles - b.triangles],
	['islands', 'Islands', (a, b) => a.islands - b.islands],
	['seams', 'Seams', (a, b) => a.seams - b.seams]];

const worstFirst = (a, b) => (b.failure ? 1 : 0) - (a.failure ? 1 : 0) || b.counts[0] - a.counts[0] || b.counts[1] - a.counts[1] ||
	b.counts[2] - a.counts[2] || a.number - b.number;

class Overview {
	constructor() {
		this.sort = null;
		this.text = '';
		this.observer = new IntersectionObserver(entries => entries.forEach(e => {
			if (!e.isIntersecting) return;
			this.observer.unobserve(e.target);
			this.drawThumb(e.target);
		}), {rootMargin: '200px'});
		$('file-columns').append(...fileColumns.map(([id, title, compare]) => element('th', {'data-column': id, scope: 'col', class: compare && id !== 'name' ? 'numeric' : null},
			compare ? element('button', {type: 'button', onclick: () => this.sortBy(id)}, title) : element('span', {class: 'hidden'}, 'Layout'))));
		$('file-text').addEventListener('input', e => { this.text = e.target.value.toLowerCase(); this.show(); });
	}

	sortBy(id) {
		const numeric = id !== 'name', same = this.sort?.id === id;
		this.sort = {id, down: same ? !this.sort.down : numeric};
		this.show();
	}

	row(file) {
		const mesh = file.meshes.find(m => m.hasGeometry && m.number === (m.same_as ?? m.number));
		const thumbs = ['model', 'layout'].map(kind => {
			const canvas = element('canvas', {class: 'thumb', width: 112, height: 80, 'aria-hidden': 'true'});
			if (file.page ? !file[kind] : kind === 'model' || !mesh || mesh.triangles > MOST_THUMB_TRIANGLES) return kind === 'model' ? null : canvas;
			Object.assign(canvas, {kind, pixels: file[kind], mesh});
			this.observer.observe(canvas);
			return canvas;
		});
		const address = file.page || '#file-' + file.number;
		const number = (n, kind) => element('td', {class: 'numeric ' + (n ? kind || '' : 'none')}, file.failure && !n ? '–' : count(n));
		const folder = file.name.slice(0, file.name.lastIndexOf('/') + 1);
		return element('tr', {class: file.failure || file.counts[0] ? 'error' : file.counts[1] ? 'warning' : 'clean', onclick: () => { location.href = address; }},
			element('td', {}, element('div', {class: 'thumbs'}, ...thumbs)),
			element('td', {class: 'name'}, element('a', {href: address, onclick: e => e.stopPropagation()}, folder && element('span', {class: 'folder'}, folder), file.name.slice(folder.length)),
				element('span', {class: 'note'}, file.verdict)),
			number(file.counts[0], 'error'), number(file.counts[1], 'warning'), number(file.counts[2], 'info'), number(file.triangles), number(file.islands), number(file.seams));
	}

	show() {
		const compare = this.sort && fileColumns.find(c => c[0] === this.sort.id)[2], sign = this.sort?.down ? -1 : 1;
		const shown = files.filter(f => !this.text || f.name.toLowerCase().includes(this.text) || f.findings.some(x => x.code.toLowerCase().includes(this.text)))
			.sort(compare ? (a, b) => sign * compare(a, b) || a.number - b.number : worstFirst);
		$('file-rows').replaceChildren(...shown.map(f => this.row(f)));
		$('files-shown').textContent = (shown.length === files.length ? plural(files.length, 'file') : count(shown.length) + ' of ' + plural(files.length, 'file')) +
			(this.sort ? '' : ', the worst first');
		document.querySelectorAll('#file-columns th').forEach(th => th.setAttribute('aria-sort',
			th.dataset.column !== this.sort?.id ? 'none' : this.sort.down ? 'descending' : 'ascending'));
	}

	// A byte for each pixel: 0 where nothing is; of a model how bright it is, of a layout its winding.
	async drawPixels({kind, pixels, width, height}, c) {
		const picture = new ImageData(width, height), model = lightOf('model'), windings = [null, colourOf('plain-line'), colourOf('mirrored-line')];
		(await inflate(fromBase64(pixels))).forEach((pixel, i) => {
			if (pixel) picture.data.set(kind === 'model' ? [...model.map(x => x * pixel), 255] : [...windings[pixel], 190], 4 * i);
		});
		c.putImageData(picture, 0, 0);
	}

	async drawThumb(canvas) {
		const c = canvas.getContext('2d');
		if (canvas.pixels) { await this.drawPixels(canvas, c); return; }
		c.globalAlpha = 0.75;
		const g = await readGeometry(canvas.mesh), uv = g.texcoords;
		if (!uv) return;
		const {low, high} = uvBox(g);
		const scale = Math.min(104 / (high[0] - low[0] || 1), 72 / (high[1] - low[1] || 1));
		c.setTransform(scale, 0, 0, scale, 56 - scale * (low[0] + high[0]) / 2, 40 - scale * (low[1] + high[1]) / 2);
		for (const region of g.regions.filter(r => !r.buried)) {
			c.fillStyle = region.mirrored ? ink('mirrored-line') : ink('plain-line');
			c.fill(outlinePath(uv, region.loops));
		}
	}
}
