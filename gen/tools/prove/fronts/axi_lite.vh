// b_stands: A write answer stays valid until it is accepted.
// r_stands: A read answer and its word stay valid until they are accepted.
// b_is_asked: A write answer comes only for an address and a word that were accepted.
// r_is_asked: A read answer comes only for an address that was accepted.
// writes_the_oldest: The bank writes for the oldest request, once, while it has no answer.
// writes_what_was_asked: A written word and its address are those of the oldest request, with all byte strobes set.
// reads_the_oldest: The bank reads for the oldest request, while it has no answer.
// bytes_in_order: The bytes of a word are read in their order, each once.
// okay_is_written: OKAY means that the word was written, or that no strobe was set.
// refused_is_not: An error is SLVERR, comes if only some strobes are set, and nothing was written.
// read_is_what_the_bank_gave: A read returns the four bytes of the bank.
// write_answers_in_time: A write is answered within 60 cycles, if the bank answers each access within four: it waits for one read at most.
// read_answers_in_time: A read is answered within 60 cycles, under the same condition.
    // A master within the rules: what it offers stands until it is taken.
    reg p_past = 0;
    reg p_aw = 0, p_w = 0, p_ar = 0, p_b = 0, p_r = 0;
    reg [12:0] p_awaddr = 0, p_araddr = 0;
    reg [31:0] p_wdata = 0, p_rdata = 0;
    reg [3:0] p_wstrb = 0;
    reg [1:0] p_bresp = 0;
    always @* begin
        if (p_aw) assume (awvalid && awaddr == p_awaddr);
        if (p_w) assume (wvalid && wdata == p_wdata && wstrb == p_wstrb);
        if (p_ar) assume (arvalid && araddr == p_araddr);
    end
    // Requests that have been taken and not been answered, the oldest one first.
    reg [1:0] aw_n = 0, w_n = 0, ar_n = 0;
    reg [10:0] aw0 = 0, aw1 = 0, ar0 = 0, ar1 = 0;
    reg [31:0] w0 = 0, w1 = 0;
    reg [3:0] s0 = 0, s1 = 0;
    reg f_wrote = 0, f_read = 0;
    reg [1:0] f_lanes = 0;
    reg [31:0] f_word = 0;
    reg [6:0] f_waits = 0, f_idle = 0;
    wire aw_in = awvalid & awready, w_in = wvalid & wready, ar_in = arvalid & arready;
    wire b_out = bvalid & bready, r_out = rvalid & rready;
    wire f_words = \u_words.access_strobe  | (\u_words.settle  != 0) | f_busy | \u_words.end_strobe ;
    wire f_config = (ar0[10:7] == 2) & !ar0[2];
    wire f_whole = \u_words.whole ;
    wire w_runs = busy & writing, r_runs = busy & !writing;
    wire w_first = w_runs | has_b, r_first = r_runs | has_r;
    always @(posedge clock) begin
        p_past <= 1;
        p_aw <= awvalid & !awready; p_w <= wvalid & !wready; p_ar <= arvalid & !arready;
        p_b <= bvalid & !bready; p_r <= rvalid & !rready;
        p_awaddr <= awaddr; p_araddr <= araddr; p_wdata <= wdata; p_wstrb <= wstrb;
        p_rdata <= rdata; p_bresp <= bresp;
        aw_n <= aw_n + aw_in - b_out;
        w_n <= w_n + w_in - b_out;
        ar_n <= ar_n + ar_in - r_out;
        if (b_out) begin aw0 <= aw1; w0 <= w1; s0 <= s1; end
        if (aw_in) begin
            if (aw_n - b_out == 0) aw0 <= awaddr[12:2]; else aw1 <= awaddr[12:2];
        end
        if (w_in) begin
            if (w_n - b_out == 0) begin w0 <= wdata; s0 <= wstrb; end
            else begin w1 <= wdata; s1 <= wstrb; end
        end
        if (r_out) ar0 <= ar1;
        if (ar_in) begin
            if (ar_n - r_out == 0) ar0 <= araddr[12:2]; else ar1 <= araddr[12:2];
        end
        f_wrote <= !b_out & (f_wrote | (access & write));
        f_read <= !r_out & (f_read | (access & !write));
        if (r_out) f_lanes <= 0; else if (access & !write) f_lanes <= lane;
        if (done && !f_write) f_word <= {f_word[23:0], read_byte};
        f_waits <= (aw_n != 0 && w_n != 0 && !bvalid && !(has_b | has_r)) ? f_waits + 1 : 0;
        f_idle <= (ar_n != 0 && !rvalid && !(has_b | has_r)) ? f_idle + 1 : 0;
    end
    always @* begin
        // Answers stand until they are taken.
        if (p_b) begin b_stands: assert (bvalid && bresp == p_bresp); end
        if (p_r) begin r_stands: assert (rvalid && rdata == p_rdata); end
        // One answer to each request, in their order; what the bank does is what the oldest one asks for, once.
        b_is_asked: assert (!bvalid || (aw_n != 0 && w_n != 0));
        r_is_asked: assert (!rvalid || ar_n != 0);
        if (access && write) begin
            writes_the_oldest: assert (aw_n != 0 && w_n != 0 && !f_wrote && !bvalid);
            writes_what_was_asked: assert (word_address == aw0 && write_data == w0 && s0 == 15);
        end
        if (access && !write) begin
            reads_the_oldest: assert (ar_n != 0 && !rvalid && word_address == ar0);
            bytes_in_order: assert (lane == (f_read ? f_lanes + 2'd1 : 2'd0));
        end
        if (bvalid) begin
            okay_is_written: assert (bresp != 0 || (s0 == 15 ? f_wrote : s0 == 0 && !f_wrote));
            refused_is_not: assert (bresp == 0 || (bresp == 2 && s0 != 15 && s0 != 0 && !f_wrote));
        end
        if (rvalid) begin
            read_is_what_the_bank_gave: assert (f_read && rresp == 0 && (f_config || (f_lanes == 3 && rdata == f_word)));
        end
        // Neither direction waits longer than for one access of the other.
        write_answers_in_time: assert (f_waits <= 60);
        read_answers_in_time: assert (f_idle <= 60);
    end
    // What holds between front, word and bank in every state that can be reached: induction needs it.
    always @* begin
        one_place: assert (\u_words.access_strobe  + (\u_words.settle  != 0) + f_busy + \u_words.end_strobe  <= 1);
        busy_is_so: assert (busy == (request | f_words) && !(request && f_words));
        if (f_busy) begin bank_has_it: assert (f_write == write && f_address == word_address); end
        one_write: assert (!(w_runs && has_b));
        one_read: assert (!(r_runs && has_r));
        aw_count: assert (aw_n == has_aw + w_first);
        w_count: assert (w_n == has_w + w_first);
        ar_count: assert (ar_n == has_ar + r_first);
        if (has_aw) begin aw_kept: assert (write_address == (w_first ? aw1 : aw0)); end
        if (has_w) begin w_kept: assert (data == (w_first ? w1 : w0) && strobes == (w_first ? s1 : s0)); end
        if (has_ar) begin ar_kept: assert (read_address == (r_first ? ar1 : ar0)); end
        if (w_runs) begin w_running: assert (address == aw0 && s0 == 15); end
        if (w_runs && request) begin w_asked: assert (data == w0); end
        if (r_runs) begin r_running: assert (address == ar0); end
        f_wrote_so: assert (f_wrote == ((w_runs && (f_busy | \u_words.end_strobe )) || (has_b && s0 == 15)));
        if (w_runs && \u_words.access_strobe ) begin w_word: assert (\u_words.data  == w0 && lane == 0 && f_whole); end
        if (w_runs && f_words) begin w_whole: assert (f_whole && lane == 0 && \u_words.settle  == 0); end
        if (has_b) begin b_error: assert (error == (s0 != 15 && s0 != 0)); end
        if (w_runs) begin no_error: assert (!error); end
        if (r_runs && f_words) begin r_whole: assert (f_whole == f_config); end
        if (f_read) begin read_is_running: assert ((r_runs && !request && \u_words.settle  == 0) || has_r); end
        else begin f_lanes_new: assert (f_lanes == 0 && !has_r && !(r_runs && (f_busy | \u_words.end_strobe ))); end
        if (r_runs && \u_words.access_strobe  && !f_read) begin first_lane: assert (lane == 0); end
        if (r_runs && \u_words.settle  != 0) begin settle_lane: assert (lane == 0); end
        if (f_read && r_runs && f_whole) begin whole_is_one: assert (lane == 0 && f_lanes == 0 && !\u_words.access_strobe ); end
        if (f_read && r_runs && !f_whole) begin
            if (f_busy) begin lanes_in_bank: assert (lane == f_lanes); end
            if (\u_words.access_strobe ) begin lanes_next: assert (lane == f_lanes + 2'd1 && f_lanes != 3); end
            if (\u_words.end_strobe ) begin lanes_end: assert (f_lanes == 3 && f_word == \u_words.data ); end
            if (lane == 1) begin word_1: assert (f_word[7:0] == \u_words.data [7:0]); end
            if (lane == 2) begin word_2: assert (f_word[15:0] == \u_words.data [15:0]); end
            if (lane == 3) begin word_3: assert (f_word[23:0] == \u_words.data [23:0]); end
        end
        if (has_r) begin word_at_last: assert (f_config || (f_lanes == 3 && f_word == answer)); end
    end
