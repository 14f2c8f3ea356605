    // The bus: an AXI4-Lite master. A handshake is looked at before the rising edge of the clock, and its end made after it.
    localparam integer ACCESS_CYCLES_MAX = {{ access_cycles_max }};
    reg awvalid, wvalid, bready, arvalid, rready;
    reg [12:0] awaddr, araddr;
    reg [31:0] wdata;
    wire awready, wready, bvalid, arready, rvalid;
    wire [1:0] bresp, rresp;
    wire [31:0] rdata;
    reg answered;

    task host_idle;
        begin
            awvalid = 1'b0;
            wvalid = 1'b0;
            bready = 1'b0;
            arvalid = 1'b0;
            rready = 1'b0;
            awaddr = 13'd0;
            araddr = 13'd0;
            wdata = 32'd0;
        end
    endtask

    task clock_edge;
        reg aw, w, b, ar, r;
        begin
            @(negedge clk);
            aw = awvalid & awready;
            w = wvalid & wready;
            b = bready & bvalid;
            ar = arvalid & arready;
            r = rready & rvalid;
            if (b)
                check("bresp", {46'd0, bresp}, 48'd0);
            if (r) begin
                check("rresp", {46'd0, rresp}, 48'd0);
                answer = rdata;
            end
            @(posedge clk);
            #(CLK_NS / 4.0);
            if (aw)
                awvalid = 1'b0;
            if (w)
                wvalid = 1'b0;
            if (ar)
                arvalid = 1'b0;
            answered = answered | b | r;
        end
    endtask

    task transfer(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            @(posedge clk);
            #(CLK_NS / 4.0);
            // The direction that is not meant has another address.
            awaddr = {address[10:0] ^ {11{~write}}, 2'b00};
            araddr = {address[10:0] ^ {11{write}}, 2'b00};
            wdata = value;
            awvalid = write;
            wvalid = write;
            bready = write;
            arvalid = ~write;
            rready = ~write;
            answered = 1'b0;
            for (k = 0; k < ACCESS_CYCLES_MAX && !answered; k = k + 1)
                clock_edge;
            check("answer on the bus", {47'd0, answered}, 48'd1);
            host_idle;
        end
    endtask
