// SPDX-License-Identifier: MIT
//
// The service worker: after the first visit the page works without a network. Its files are fetched once, together, and from
// then on nothing else is: what is not among them is an error. Another version (the name of the cache) takes over when the
// last page of this one is closed.
const CACHE = 'nmtan-@VERSION@', FILES = '@FILES@'.split(' ');

addEventListener('install', event => event.waitUntil(caches.open(CACHE).then(cache => cache.addAll(FILES))));

addEventListener('activate', event => event.waitUntil(caches.keys().then(names =>
	Promise.all(names.filter(name => name.startsWith('nmtan-') && name !== CACHE).map(name => caches.delete(name))))));

addEventListener('fetch', event => event.respondWith(caches.open(CACHE)
	.then(cache => cache.match(event.request, {ignoreSearch: true})).then(answer => answer ?? Response.error())));
